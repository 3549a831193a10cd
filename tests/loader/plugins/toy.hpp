// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>

#include "petal/plugin.hpp"

// The least that a plugin needs: a packet type and a stage. Each bad plugin here adds one fault.

namespace toys {

struct Toy {
    int value = 0;
};

struct ToyParams {
    double factor = 2.0;
};

class ToySource final : public petal::Stage {
   public:
    using Params = ToyParams;
    static void describe(petal::Spec<Params>& s);
    explicit ToySource(Params params) : params_(params) {}
    void run(petal::Run& run) override;

   private:
    Params params_;
};

}  // namespace toys

template <>
struct petal::PacketTraits<toys::Toy> {
    static constexpr const char* name = "Toy";
    static void seal(toys::Toy&) {}
    static std::size_t bytes(const toys::Toy&) { return sizeof(toys::Toy); }
};

namespace toys {

inline void ToySource::describe(petal::Spec<Params>& s) {
    s.summary("Emits no toys.");
    s.writes<Toy>("toy", "a toy");
    s.param("factor", &Params::factor).unit("1").within(0.0, 10.0).doc("scales nothing");
}

inline void ToySource::run(petal::Run& run) {
    run.end_of_data();
}

}  // namespace toys

// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

// A stage whose parameter has neither unit nor range.
#include "toy.hpp"

namespace {
class Incomplete final : public petal::Stage {
   public:
    using Params = toys::ToyParams;
    static void describe(petal::Spec<Params>& s) {
        s.summary("Leaves things out.");
        s.writes<toys::Toy>("toy", "a toy");
        s.param("factor", &Params::factor).doc("of what?");
    }
    explicit Incomplete(Params) {}
};
}  // namespace

PETAL_PLUGIN("incomplete", "1.0.0",
             [](petal::Registrar& r) { r.add<Incomplete>("toys.incomplete"); });

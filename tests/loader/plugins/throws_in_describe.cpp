// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

// The declaration of its stage throws.
#include <stdexcept>

#include "toy.hpp"

namespace {
class Undescribable final : public petal::Stage {
   public:
    using Params = toys::ToyParams;
    static void describe(petal::Spec<Params>&) { throw std::logic_error("beyond words"); }
    explicit Undescribable(Params) {}
};
}  // namespace

PETAL_PLUGIN("throws_in_describe", "1.0.0",
             [](petal::Registrar& r) { r.add<Undescribable>("toys.undescribable"); });

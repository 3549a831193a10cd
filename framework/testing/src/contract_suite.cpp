// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/testing/contract_suite.hpp"

#include <cmath>
#include <limits>
#include <set>

#include "declaration_check.hpp"
#include "petal/error.hpp"
#include "petal/run.hpp"
#include "petal/testing/stage_harness.hpp"

namespace petal::testing {

namespace {

/// How one firing ended, and what it wrote.
struct Outcome {
    enum class End { wrote, refused, cancelled, broke };
    End end = End::wrote;
    std::string message;
    std::map<std::string, std::vector<std::size_t>>
        sizes;  ///< bytes of each packet, by output port

    bool operator==(const Outcome& other) const {
        return end == other.end && message == other.message && sizes == other.sizes;
    }
};

class Suite {
   public:
    Suite(const StageSpec& spec, const ContractInputs& inputs) : spec_(spec), inputs_(inputs) {}

    std::vector<Violation> run() {
        for (const std::string& fault : declaration_faults(spec_))
            violate("complete declaration", fault);
        check_parameters();
        for (const std::string& name : input_names()) check_input(name);
        return violations_;
    }

   private:
    void violate(const std::string& rule, const std::string& what) {
        violations_.push_back({rule, what});
    }

    /// True when the harness takes the value.
    bool takes(const std::string& param, const Value& value) {
        StageHarness harness(spec_);
        try {
            harness.set(param, value);
            return true;
        } catch (const Error&) {
            return false;
        }
    }

    void check_parameters() {
        if (spec_.check_params) {
            const auto defaults = spec_.make_params();
            for (const std::string& problem : spec_.check_params(defaults.get()))
                violate("legal defaults", problem);
        }
        if (takes("no_such_parameter", Value(true)))
            violate("unknown names", "'no_such_parameter' was taken");
        for (const ParamSpec& param : spec_.params) check_parameter(param);
    }

    void check_parameter(const ParamSpec& param) {
        if (!takes(param.name, param.default_value))
            violate("legal defaults", param.name + " does not take its own default");
        const Value wrong_kind = std::holds_alternative<bool>(param.default_value)
                                     ? Value(std::string("no"))
                                     : Value(true);
        if (takes(param.name, wrong_kind))
            violate("wrong kind", param.name + " takes another kind");
        if (param.list) return;
        if (std::holds_alternative<double>(param.default_value)) {
            check_edge<double>(param, param.min, -1.0);
            check_edge<double>(param, param.max, 1.0);
            if (takes(param.name, Value(std::numeric_limits<double>::quiet_NaN())))
                violate("range", param.name + " takes NaN");
        } else if (std::holds_alternative<std::int64_t>(param.default_value)) {
            check_edge<std::int64_t>(param, param.min, -1.0);
            check_edge<std::int64_t>(param, param.max, 1.0);
        } else if (param.kind == Kind::choice) {
            for (const std::string& choice : param.choices)
                if (!takes(param.name, Value(choice)))
                    violate("choices", param.name + " refuses its choice " + choice);
            if (takes(param.name, Value(std::string("no such choice"))))
                violate("choices", param.name + " takes what is no choice");
        }
    }

    template <class Number>
    void check_edge(const ParamSpec& param, std::optional<double> edge, double outwards) {
        if (!edge) return;
        if (!takes(param.name, Value(static_cast<Number>(*edge))))
            violate("range edge", param.name + " refuses the edge of its range");
        const double outside = *edge + outwards * std::max(1.0, std::abs(*edge) * 0.01);
        if (takes(param.name, Value(static_cast<Number>(outside))))
            violate("range", param.name + " takes a value outside its range");
    }

    std::set<std::string> input_names() const {
        std::set<std::string> names;
        for (const PortSpec& port : spec_.inputs) {
            const auto found = inputs_.packets.find(port.type);
            if (found == inputs_.packets.end()) continue;
            for (const auto& [name, make] : found->second) names.insert(name);
        }
        names.insert("empty");
        return names;
    }

    /// The packet of that name for a port, else its "empty"; none where the type is unknown.
    AnyPacket packet_for(const PortSpec& port, const std::string& name) const {
        const auto type = inputs_.packets.find(port.type);
        if (type == inputs_.packets.end()) return {};
        auto maker = type->second.find(name);
        if (maker == type->second.end()) maker = type->second.find("empty");
        return maker == type->second.end() ? AnyPacket{} : maker->second();
    }

    void check_input(const std::string& name) {
        std::vector<std::pair<std::string, AnyPacket>> given;
        for (const PortSpec& port : spec_.inputs) {
            AnyPacket packet = packet_for(port, name);
            if (packet) given.emplace_back(port.name, packet);
            if (!packet && !port.optional) {
                violate("inputs", "no '" + name + "' packet of type " + port.type + " to try");
                return;
            }
        }
        const Outcome first = fire(given, false);
        const Outcome second = fire(given, false);
        const Outcome cancelled = fire(given, true);
        const std::string with = "with the input '" + name + "': ";
        if (first.end == Outcome::End::broke) violate("errors", with + first.message);
        if (first.end == Outcome::End::refused && first.message.empty())
            violate("errors", with + "an error without a message");
        if (!(first == second)) violate("same input, same output", with + "two firings differ");
        if (cancelled.end == Outcome::End::broke ||
            (cancelled.end == Outcome::End::refused && first.end != Outcome::End::refused))
            violate("cancel", with + "cancelled: " + cancelled.message);
    }

    Outcome fire(const std::vector<std::pair<std::string, AnyPacket>>& given, bool cancel) {
        StageHarness harness(spec_);
        if (cancel) harness.cancel();
        Outcome outcome;
        try {
            for (const auto& [port, packet] : given) harness.give_packet(port, packet);
            harness.fire();
            for (const PortSpec& port : spec_.outputs)
                for (const AnyPacket& packet : harness.written(port.name))
                    outcome.sizes[port.name].push_back(packet.bytes);
        } catch (const Cancelled&) {
            outcome.end = Outcome::End::cancelled;
        } catch (const Error& error) {
            outcome.end = Outcome::End::refused;
            outcome.message = error.what();
        } catch (const std::exception& error) {
            outcome.end = Outcome::End::broke;
            outcome.message = std::string("threw what is no petal::Error: ") + error.what();
        } catch (...) {
            outcome.end = Outcome::End::broke;
            outcome.message = "threw what is no std::exception";
        }
        return outcome;
    }

    const StageSpec& spec_;
    const ContractInputs& inputs_;
    std::vector<Violation> violations_;
};

}  // namespace

std::vector<Violation> contract_violations(const StageSpec& spec, const ContractInputs& inputs) {
    return Suite(spec, inputs).run();
}

}  // namespace petal::testing

// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/testing/contract_suite.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "contract_firing.hpp"
#include "declaration_check.hpp"
#include "param_values.hpp"
#include "petal/error.hpp"
#include "petal/testing/stage_harness.hpp"

namespace petal::testing {

namespace {

using End = FiringOutcome::End;

/// What a cancelled stage may take. Far more than one that polls needs on a busy machine.
constexpr double kSoon = 2.0;  // s
/// With extreme parameters a stage may have work for hours: it is asked to stop.
constexpr double kEdgeTime = 0.5;  // s

class Suite {
   public:
    Suite(const StageSpec& spec, const ContractInputs& inputs) : spec_(spec), inputs_(inputs) {}

    std::vector<Violation> run() {
        for (const std::string& fault : declaration_faults(spec_))
            violate("complete declaration", fault);
        check_contents();
        check_parameters();
        if (!violations_.empty()) return violations_;  // the rest takes the declaration at its word
        for (const std::string& name : input_names()) check_input(name);
        for (const ParamSpec& param : spec_.params) check_edges(param);
        return violations_;
    }

   private:
    void violate(const std::string& rule, const std::string& what) {
        violations_.push_back({rule, what});
    }

    void check_contents() {
        std::set<std::string> types;
        for (const auto* ports : {&spec_.inputs, &spec_.outputs})
            for (const PortSpec& port : *ports) types.insert(port.type);
        for (const std::string& type : types)
            if (inputs_.contents.count(type) == 0)
                violate("contents", "no content function for packets of type " + type +
                                        "; give one with ContractInputs::add_content");
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

    /// The packet of that name for a port, else its "typical", else its "empty"; none where the
    /// type is unknown.
    AnyPacket packet_for(const PortSpec& port, const std::string& name) const {
        const auto type = inputs_.packets.find(port.type);
        if (type == inputs_.packets.end()) return {};
        for (const std::string& one : {name, std::string("typical"), std::string("empty")})
            if (const auto maker = type->second.find(one); maker != type->second.end())
                return maker->second();
        return {};
    }

    /// False where a port that must be wired has no packet.
    bool packets_for(const std::string& name, GivenPackets& given) {
        for (const PortSpec& port : spec_.inputs) {
            AnyPacket packet = packet_for(port, name);
            if (!packet && !port.optional) {
                violate("inputs", "no '" + name + "' packet of type " + port.type + " to try");
                return false;
            }
            if (packet) given.emplace_back(port.name, std::move(packet));
        }
        return true;
    }

    std::string content_of_all(const GivenPackets& given) const {
        std::string content;
        for (const auto& [port, packet] : given) content += port + content_of(inputs_, packet);
        return content;
    }

    void check_input(const std::string& name) {
        GivenPackets given;
        if (!packets_for(name, given)) return;
        const std::string with = "with the input '" + name + "': ";
        const std::string before = content_of_all(given);
        const FiringOutcome first = fire_once(spec_, inputs_, given, {});
        if (content_of_all(given) != before)
            violate("inputs unchanged", with + "the stage changed a packet that it was given");
        if (first.end == End::broke) violate("errors", with + first.message);
        if (first.end == End::refused && first.message.empty())
            violate("errors", with + "an error without a message");
        check_repeated(with, given, first);
        check_cancel(with, given, first);
    }

    void check_repeated(const std::string& with, const GivenPackets& given,
                        const FiringOutcome& first) {
        const auto compare = [&](const FiringWay& way, const std::string& rule,
                                 const std::string& how) {
            const FiringOutcome other = fire_once(spec_, inputs_, given, way);
            if (!(first == other)) violate(rule, with + how + ": " + difference(first, other));
        };
        compare({}, "same seed, same output", "a second instance differs");
        FiringWay way;
        way.threads = 4;
        compare(way, "threads", "four threads instead of one");
        way.threads = 1;
        way.change_threads = true;
        compare(way, "threads", "each call from another thread");
    }

    static std::string difference(const FiringOutcome& a, const FiringOutcome& b) {
        if (a.end != b.end || a.message != b.message)
            return "it ends otherwise ('" + a.message + "' and '" + b.message + "')";
        if (a.told != b.told) return "outputs, notes or verdict differ";
        return "files differ";
    }

    void check_cancel(const std::string& with, const GivenPackets& given,
                      const FiringOutcome& whole) {
        FiringWay way;
        way.cancelled = true;
        const FiringOutcome outcome = fire_once(spec_, inputs_, given, way);
        if (outcome.end == End::broke || (outcome.end == End::refused && whole.end != End::refused))
            violate("cancel", with + "cancelled: " + outcome.message);
        if (outcome.seconds > kSoon && outcome.seconds > 0.5 * whole.seconds)
            violate("cancel", with + "a cancelled firing goes on; poll check_cancelled()");
        for (const auto& [file, content] : outcome.files) {
            const auto found = whole.files.find(file);
            if (found == whole.files.end() || found->second != content)
                violate("cancel", with + "a cancelled firing leaves the file " + file +
                                      " half written; use Run::output or a PendingFile");
        }
    }

    /// Fires with the extreme values of one parameter, the others as by default.
    void check_edges(const ParamSpec& param) {
        std::vector<Value> values;
        for (const std::optional<double>& edge : {param.min, param.max}) {
            if (param.list || !edge) continue;
            if (std::holds_alternative<double>(param.default_value)) values.emplace_back(*edge);
            if (std::holds_alternative<std::int64_t>(param.default_value))
                values.emplace_back(static_cast<std::int64_t>(*edge));
        }
        if (!param.list)
            for (const std::string& choice : param.choices) values.emplace_back(choice);
        if (!param.list && std::holds_alternative<bool>(param.default_value))
            values.emplace_back(!std::get<bool>(param.default_value));
        for (const Value& value : values)
            for (const char* name : {"typical", "empty"}) check_edge_value(param, value, name);
    }

    void check_edge_value(const ParamSpec& param, const Value& value, const std::string& name) {
        GivenPackets given;
        if (!packets_for(name, given)) return;
        FiringWay way;
        way.params[param.name] = value;
        way.cancel_after_s = kEdgeTime;
        const FiringOutcome outcome = fire_once(spec_, inputs_, given, way);
        if (outcome.end == End::broke)
            violate("edges", param.name + " = " + value_text(value) + ", input '" + name +
                                 "': " + outcome.message);
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

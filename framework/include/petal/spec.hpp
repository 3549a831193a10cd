// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "petal/packet.hpp"
#include "petal/stage.hpp"
#include "petal/value.hpp"

namespace petal {

/// A parameter as declared. `set` writes a Value into the stage's Params struct.
struct ParamSpec {
    std::string name;
    Kind kind = Kind::boolean;
    bool list = false;
    std::string unit;           ///< "m", "deg", "px", "1" (none); every double has one
    std::optional<double> min;  ///< inclusive; of each element of a list
    std::optional<double> max;  ///< inclusive
    std::vector<std::string> choices;
    std::string doc;
    Value default_value;
    std::function<void(void* params, const Value&)> set;
};

struct PortSpec {
    std::string name;
    std::string type;  ///< PacketTraits<T>::name
    std::string doc;
    bool optional = false;
    bool gathers = false;
};

/// All that is known of a stage type without making one. Values are plain, so that the check, the
/// catalogue, the documentation and the tests read the same declaration.
struct StageSpec {
    std::string type;
    std::string summary;  ///< one sentence
    std::string doc;      ///< paragraphs of Markdown: formulas, sources, limits
    std::string role;     ///< empty where no other stage can take its place
    std::vector<PortSpec> inputs;
    std::vector<PortSpec> outputs;
    std::vector<ParamSpec> params;
    std::string plugin;          ///< filled by the loader: the plugin's name
    std::string plugin_version;  ///< and its version
    std::string library;         ///< and its file

    std::function<std::shared_ptr<void>()> make_params;  ///< with every default
    std::function<std::unique_ptr<Stage>(const void* params)> make_stage;
    /// Relations between parameters: one sentence for each that is violated.
    std::function<std::vector<std::string>(const void* params)> check_params;

    const ParamSpec* find_param(const std::string& name) const;
    const PortSpec* find_input(const std::string& name) const;
    const PortSpec* find_output(const std::string& name) const;
    bool is_source() const { return inputs.empty(); }
    bool gathers() const;
};

namespace detail {

template <class M>
struct ParamKind;  // a member type that has no specialisation here cannot be a parameter
template <>
struct ParamKind<bool> {
    static constexpr Kind kind = Kind::boolean;
    using Stored = bool;
};
template <>
struct ParamKind<int> {
    static constexpr Kind kind = Kind::integer;
    using Stored = std::int64_t;
};
template <>
struct ParamKind<std::int64_t> {
    static constexpr Kind kind = Kind::integer;
    using Stored = std::int64_t;
};
template <>
struct ParamKind<double> {
    static constexpr Kind kind = Kind::real;
    using Stored = double;
};
template <>
struct ParamKind<std::string> {
    static constexpr Kind kind = Kind::text;
    using Stored = std::string;
};
template <>
struct ParamKind<std::filesystem::path> {
    static constexpr Kind kind = Kind::path;
    using Stored = std::string;
};

template <class M>
struct Codec {
    static constexpr Kind kind = ParamKind<M>::kind;
    static constexpr bool list = false;
    using Stored = typename ParamKind<M>::Stored;
    static Value get(const M& member) {
        if constexpr (std::is_same_v<M, std::filesystem::path>) {
            return Value(member.string());
        } else {
            return Value(static_cast<Stored>(member));
        }
    }
    static void set(M& member, const Value& value) {
        member = static_cast<M>(std::get<Stored>(value));
    }
};
template <class E>
struct Codec<std::vector<E>> {
    static constexpr Kind kind = ParamKind<E>::kind;
    static constexpr bool list = true;
    using Stored = typename ParamKind<E>::Stored;
    static Value get(const std::vector<E>& member) {
        std::vector<Stored> values;
        values.reserve(member.size());
        for (const auto& element : member)
            values.push_back(std::get<Stored>(Codec<E>::get(element)));
        return Value(std::move(values));
    }
    static void set(std::vector<E>& member, const Value& value) {
        member.clear();
        for (const auto& element : std::get<std::vector<Stored>>(value))
            member.push_back(static_cast<E>(element));
    }
};

}  // namespace detail

/// Refines one parameter; returned by Spec::param.
class ParamBuilder {
   public:
    explicit ParamBuilder(ParamSpec& spec) : spec_(spec) {}
    ParamBuilder& unit(std::string text) {
        spec_.unit = std::move(text);
        return *this;
    }
    /// Inclusive bounds, in the unit.
    ParamBuilder& within(double min, double max) {
        spec_.min = min;
        spec_.max = max;
        return *this;
    }
    ParamBuilder& at_least(double min) {
        spec_.min = min;
        return *this;
    }
    /// Turns a string into a choice.
    ParamBuilder& choices(std::vector<std::string> names) {
        spec_.kind = Kind::choice;
        spec_.choices = std::move(names);
        return *this;
    }
    ParamBuilder& doc(std::string text) {
        spec_.doc = std::move(text);
        return *this;
    }

   private:
    ParamSpec& spec_;
};

/// Refines one input port; returned by Spec::reads and Spec::gathers.
class PortBuilder {
   public:
    explicit PortBuilder(PortSpec& spec) : spec_(spec) {}
    PortBuilder& optional() {
        spec_.optional = true;
        return *this;
    }

   private:
    PortSpec& spec_;
};

/// What describe() fills in. Builders refer into the spec: use them in the same statement.
template <class Params>
class Spec {
   public:
    explicit Spec(StageSpec& spec) : spec_(spec) {}

    void summary(std::string text) { spec_.summary = std::move(text); }
    void doc(std::string markdown) { spec_.doc = std::move(markdown); }
    void role(std::string name) { spec_.role = std::move(name); }

    /// One packet for each firing.
    template <class T>
    PortBuilder reads(std::string name, std::string doc) {
        spec_.inputs.push_back(
            {std::move(name), PacketTraits<T>::name, std::move(doc), false, false});
        return PortBuilder(spec_.inputs.back());
    }
    /// Every packet of one or more wires, in finish().
    template <class T>
    PortBuilder gathers(std::string name, std::string doc) {
        spec_.inputs.push_back(
            {std::move(name), PacketTraits<T>::name, std::move(doc), false, true});
        return PortBuilder(spec_.inputs.back());
    }
    template <class T>
    void writes(std::string name, std::string doc) {
        spec_.outputs.push_back(
            {std::move(name), PacketTraits<T>::name, std::move(doc), false, false});
    }

    /// Declares a parameter; its default is the member's initialiser in Params, and nowhere else.
    template <class M, class Owner>
    ParamBuilder param(std::string name, M Owner::*member) {
        static_assert(std::is_base_of_v<Owner, Params>, "a member of Params, or of a base of it");
        using Codec = detail::Codec<M>;
        ParamSpec param;
        param.name = std::move(name);
        param.kind = Codec::kind;
        param.list = Codec::list;
        param.default_value = Codec::get(Params{}.*member);
        param.set = [member](void* params, const Value& value) {
            Codec::set(static_cast<Params*>(params)->*member, value);
        };
        if constexpr (std::is_same_v<M, int> || std::is_same_v<M, std::vector<int>>) {
            param.min = std::numeric_limits<int>::min();
            param.max = std::numeric_limits<int>::max();
        }
        spec_.params.push_back(std::move(param));
        return ParamBuilder(spec_.params.back());
    }

    /// A relation between parameters: returns an empty string when it holds, else one sentence.
    void check(std::function<std::string(const Params&)> relation) {
        auto before = std::move(spec_.check_params);
        spec_.check_params = [before, relation](const void* params) {
            auto found = before ? before(params) : std::vector<std::string>{};
            if (auto text = relation(*static_cast<const Params*>(params)); !text.empty())
                found.push_back(std::move(text));
            return found;
        };
    }

   private:
    StageSpec& spec_;
};

/// The declaration of stage class S under the name `type`.
template <class S>
StageSpec describe_stage(std::string type) {
    using Params = typename S::Params;
    StageSpec spec;
    spec.type = std::move(type);
    spec.make_params = [] { return std::static_pointer_cast<void>(std::make_shared<Params>()); };
    spec.make_stage = [](const void* params) -> std::unique_ptr<Stage> {
        return std::make_unique<S>(*static_cast<const Params*>(params));
    };
    Spec<Params> builder(spec);
    S::describe(builder);
    return spec;
}

}  // namespace petal

// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "json_reader.hpp"

#include <charconv>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include "counting_iterator.hpp"

namespace petal {
namespace {

bool is_number_char(char c) {
    return (c >= '0' && c <= '9') || c == '+' || c == '-' || c == '.' || c == 'e' || c == 'E';
}

bool starts_with(std::string_view text, std::string_view start) {
    return text.substr(0, start.size()) == start;
}

/// nlohmann names one token where a comma would do as well.
std::string with_comma(std::string message) {
    for (const char* closing : {"']'", "'}'"}) {
        const std::string ending = std::string("; expected ") + closing;
        if (message.size() >= ending.size() &&
            message.compare(message.size() - ending.size(), ending.size(), ending) == 0)
            return message + " or ','";
    }
    return message;
}

/// nlohmann's text without its own name, position and raw bytes: "syntax error while parsing value
/// - unexpected '}'; expected '[', '{', or a literal".
std::string syntax_message(const std::string& what) {
    const std::size_t start = what.find("syntax error");
    if (start == std::string::npos) return "no JSON: " + printable(what);
    std::string text = what.substr(start);
    const std::string quote = "; last read: '";
    const std::size_t quoted = text.find(quote);
    if (quoted == std::string::npos) return with_comma(text);
    // What was read last may be long, or no text at all: only its end tells something.
    constexpr std::size_t kTail = 24;
    const std::size_t from = quoted + quote.size();
    const std::size_t expectation = text.rfind("'; expected ");
    const bool expects = expectation != std::string::npos && expectation >= from;
    const std::size_t to = expects ? expectation : text.rfind('\'');
    std::string last = to > from ? text.substr(from, to - from) : std::string();
    if (last.size() > kTail) last = last.substr(last.size() - kTail);
    std::string ascii;
    for (const char c : last) ascii += static_cast<unsigned char>(c) < 0x80 ? c : '?';
    return with_comma(text.substr(0, quoted) + "; last read: '" + printable(ascii) + "'" +
                      (expects ? text.substr(expectation + 1) : ""));
}

/// Builds the tree from nlohmann's events.
class TreeBuilder final : public nlohmann::json_sax<nlohmann::json> {
   public:
    TreeBuilder(std::string_view text, const ReadPosition& position, std::size_t file,
                std::string path, ProblemList& problems)
        : text_(text), position_(position), file_(file), path_(std::move(path)), list_(problems) {}

    JsonNode take_root() { return std::move(root_); }

    bool null() override {
        add(JsonNode::Kind::null);
        return true;
    }
    bool boolean(bool value) override {
        add(JsonNode::Kind::boolean).boolean = value;
        return true;
    }
    bool number_integer(number_integer_t value) override {
        JsonNode& node = add_number(JsonNode::Kind::integer);
        node.negative = value < 0;
        node.magnitude =
            value < 0 ? 0U - static_cast<std::uint64_t>(value) : static_cast<std::uint64_t>(value);
        node.real = static_cast<double>(value);
        return true;
    }
    bool number_unsigned(number_unsigned_t value) override {
        JsonNode& node = add_number(JsonNode::Kind::integer);
        node.magnitude = value;
        node.real = static_cast<double>(value);
        return true;
    }
    bool number_float(number_float_t, const string_t&) override {
        JsonNode& node = add_number(JsonNode::Kind::real);
        // nlohmann reads an integer that is too large as a double.
        if (node.text.find_first_of(".eE") == std::string::npos) {
            refuse(node, "does not fit 64 bits; expected a smaller number");
            return true;
        }
        // nlohmann's value depends on the locale's decimal point; this does not.
        const char* end = node.text.data() + node.text.size();
        if (std::from_chars(node.text.data(), end, node.real).ec != std::errc())
            refuse(node,
                   "does not fit a double; expected a number of 1e-307 to 1e308 in size, or 0");
        return true;
    }
    bool string(string_t& value) override {
        add(JsonNode::Kind::text).text = std::move(value);
        return true;
    }
    bool binary(binary_t&) override { return false; }  // not in JSON text

    bool start_object(std::size_t) override { return open(JsonNode::Kind::object); }
    bool start_array(std::size_t) override { return open(JsonNode::Kind::array); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }

    bool key(string_t& name) override {
        JsonNode& object = *open_.back();
        const Origin origin{file_, position_.line};
        if (!keys_.back().insert(name).second) {
            const JsonMember* first = object.find(name);
            list_.add(origin, path_join(path(), name),
                      "duplicate key '" + printable(name) + "'; it stands in line " +
                          std::to_string(first->origin.line) + " already; expected once");
            object.erase(name);
        }
        object.members.push_back({name, origin, JsonNode{}});
        waiting_for_value_ = true;
        return true;
    }

    bool parse_error(std::size_t, const std::string& last_token,
                     const nlohmann::detail::exception& error) override {
        constexpr int kNumberOverflow = 406;
        const bool overflow = error.id == kNumberOverflow;
        // In a list the value that was not read is the one after those that were.
        const bool at_value =
            overflow || std::string_view(error.what()).find("parsing value") != std::string::npos;
        std::string place = path();
        if (at_value && !open_.empty() && open_.back()->is(JsonNode::Kind::array)) {
            const std::size_t read = open_.back()->elements.size();
            if (read > 0) place.erase(place.rfind('['));
            place = path_join(place, read);
        }
        list_.add({file_, position_.line}, place,
                  overflow ? printable(last_token) +
                                 " does not fit a double; expected a number up to 1e308"
                           : syntax_message(error.what()));
        return false;
    }

   private:
    /// The place that is being read.
    std::string path() const {
        std::string place = path_;
        for (const JsonNode* node : open_) {
            if (node->is(JsonNode::Kind::array)) {
                if (!node->elements.empty()) place = path_join(place, node->elements.size() - 1);
            } else if (!node->members.empty() && (node != open_.back() || waiting_for_value_)) {
                place = path_join(place, node->members.back().key);
            }
        }
        return place;
    }

    JsonNode& add(JsonNode::Kind kind) {
        JsonNode* node = &root_;
        if (!open_.empty()) {
            JsonNode& parent = *open_.back();
            if (parent.is(JsonNode::Kind::array)) parent.elements.emplace_back();
            node = parent.is(JsonNode::Kind::array) ? &parent.elements.back()
                                                    : &parent.members.back().value;
        }
        node->kind = kind;
        node->origin = {file_, position_.line};
        waiting_for_value_ = false;
        return *node;
    }

    /// The number's own text: it ends where the reader is, or one character before.
    JsonNode& add_number(JsonNode::Kind kind) {
        std::size_t end = position_.consumed;
        if (end > 0 && !is_number_char(text_[end - 1])) --end;
        std::size_t begin = end;
        while (begin > 0 && is_number_char(text_[begin - 1])) --begin;
        JsonNode& node = add(kind);
        node.text = std::string(text_.substr(begin, end - begin));
        return node;
    }

    void refuse(JsonNode& number, const std::string& why) {
        waiting_for_value_ = true;  // so that path() names the member
        list_.add(number.origin, path(), printable(number.text) + " " + why);
        waiting_for_value_ = false;
        number.kind = JsonNode::Kind::invalid;
    }

    bool open(JsonNode::Kind kind) {
        if (open_.size() >= kDeepestJson) {
            // The path would have 64 keys: its first two tell enough.
            open_.resize(2);
            waiting_for_value_ = true;
            list_.add({file_, position_.line}, path(),
                      "nested too deep; expected at most " + std::to_string(kDeepestJson) +
                          " lists and objects inside one another");
            return false;
        }
        JsonNode& node = add(kind);
        // Stays valid: a parent gets no further child while this one is open.
        open_.push_back(&node);
        keys_.emplace_back();
        return true;
    }

    bool close() {
        open_.pop_back();
        keys_.pop_back();
        return true;
    }

    std::string_view text_;
    const ReadPosition& position_;
    std::size_t file_;
    std::string path_;
    ProblemList& list_;
    JsonNode root_;
    std::vector<JsonNode*> open_;
    std::vector<std::set<std::string>> keys_;  ///< of each open object
    bool waiting_for_value_ = false;           ///< a key was read, its value was not
};

}  // namespace

std::optional<JsonNode> read_json(std::string_view text, std::size_t file, const std::string& path,
                                  ProblemList& problems) {
    const Origin start{file, 1};
    if (starts_with(text, "\xEF\xBB\xBF")) {
        problems.add(start, path, "begins with a byte order mark; expected UTF-8 without one");
        return std::nullopt;
    }
    if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) {
        problems.add(start, path, "is empty; expected JSON");
        return std::nullopt;
    }
    const std::size_t zero = text.find('\0');
    if (zero != std::string_view::npos) {
        problems.add(
            start, path,
            "is no text (byte " + std::to_string(zero) + " is zero); expected JSON in UTF-8");
        return std::nullopt;
    }
    ReadPosition position;
    TreeBuilder builder(text, position, file, path, problems);
    const bool read =
        nlohmann::json::sax_parse(CountingIterator(text.data(), &position),
                                  CountingIterator(text.data() + text.size(), &position), &builder,
                                  nlohmann::json::input_format_t::json, true, true);
    if (!read) return std::nullopt;
    return builder.take_root();
}

}  // namespace petal

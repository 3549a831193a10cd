// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <iterator>

namespace petal {

/// How far a reader has come.
struct ReadPosition {
    std::size_t consumed = 0;  ///< characters
    int line = 1;              ///< of the last consumed character; '\n' belongs to the line it ends
    bool line_break_last = false;  ///< the last consumed character was '\n'
};

/// Input iterator over a text that counts lines while it is read. A reader that looks one character
/// ahead (as for the end of a number) still has the right line: a line begins with its first
/// character, not with the break before it.
class CountingIterator {
   public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    /// Both must outlive the iterator.
    CountingIterator(const char* at, ReadPosition* position) : at_(at), position_(position) {}

    reference operator*() const { return *at_; }
    CountingIterator& operator++() {
        if (position_->line_break_last) ++position_->line;
        position_->line_break_last = *at_ == '\n';
        ++position_->consumed;
        ++at_;
        return *this;
    }
    CountingIterator operator++(int) {
        CountingIterator before = *this;
        ++*this;
        return before;
    }
    bool operator==(const CountingIterator& other) const { return at_ == other.at_; }
    bool operator!=(const CountingIterator& other) const { return at_ != other.at_; }

   private:
    const char* at_;
    ReadPosition* position_;
};

}  // namespace petal

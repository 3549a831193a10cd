// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace petal {

/// Of all that is added the `most` values of least cost; of equal cost those that came first. Never
/// holds more, whatever is added.
template <class Value>
class LeastKept {
   public:
    explicit LeastKept(std::size_t most) : most_(most) {}

    void add(double cost, Value value) {
        Entry entry{cost, added_++, std::move(value)};
        if (kept_.size() == most_) {
            if (most_ == 0 || !before(entry, kept_.front())) return;
            std::pop_heap(kept_.begin(), kept_.end(), before);
            kept_.back() = std::move(entry);
        } else {
            kept_.push_back(std::move(entry));
        }
        std::push_heap(kept_.begin(), kept_.end(), before);
    }
    std::size_t size() const { return kept_.size(); }

    /// The least cost first; empty afterwards.
    std::vector<Value> take() {
        std::sort_heap(kept_.begin(), kept_.end(), before);
        std::vector<Value> values;
        values.reserve(kept_.size());
        for (Entry& entry : kept_) values.push_back(std::move(entry.value));
        kept_.clear();
        return values;
    }

   private:
    struct Entry {
        double cost;
        std::size_t order;
        Value value;
    };
    static bool before(const Entry& a, const Entry& b) {
        return a.cost != b.cost ? a.cost < b.cost : a.order < b.order;
    }

    std::size_t most_;
    std::size_t added_ = 0;
    std::vector<Entry> kept_;  // a heap, the worst first
};

}  // namespace petal

// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "pipeline.hpp"

namespace petal {

/// Where something was written: which of the inputs (pipeline, patches, --set, in this order), and
/// its line there (1-based; 0 on the command line).
struct Origin {
    std::size_t file = 0;
    int line = 0;
};

/// Everything that is found wrong, and the names of the inputs it is found in.
class ProblemList {
   public:
    /// Adds an input, named as the user named it. \returns its number, for Origin::file.
    std::size_t add_file(std::string name);
    /// Where `origin` is, in words: "FILE:LINE", or FILE where there is no line.
    std::string where(const Origin& origin) const;

    void add(const Origin& origin, std::string path, std::string message);
    void add_missing_type(const Origin& origin, std::string path, std::string message);

    std::size_t size() const { return found_.size(); }
    bool empty() const { return found_.empty(); }
    /// By input, then by line, then in the order in which they were found.
    std::vector<Problem> sorted() const;

   private:
    struct Found {
        std::size_t file;
        Problem problem;
    };
    std::vector<std::string> files_;
    std::vector<Found> found_;
};

}  // namespace petal

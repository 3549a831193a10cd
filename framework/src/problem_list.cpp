// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "problem_list.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace petal {

std::string to_string(const Problem& problem) {
    std::string text = problem.file;
    if (problem.line > 0) text += ":" + std::to_string(problem.line);
    if (!problem.path.empty()) text += (text.empty() ? "" : ": ") + problem.path;
    return (text.empty() ? "" : text + ": ") + problem.message;
}

std::size_t ProblemList::add_file(std::string name) {
    files_.push_back(std::move(name));
    return files_.size() - 1;
}

std::string ProblemList::where(const Origin& origin) const {
    const std::string& file = files_.at(origin.file);
    return origin.line > 0 ? file + ":" + std::to_string(origin.line) : file;
}

void ProblemList::add(const Origin& origin, std::string path, std::string message) {
    Problem problem;
    problem.file = files_.at(origin.file);
    problem.line = origin.line;
    problem.path = std::move(path);
    problem.message = std::move(message);
    found_.push_back({origin.file, std::move(problem)});
}

void ProblemList::add_missing_type(const Origin& origin, std::string path, std::string message) {
    add(origin, std::move(path), std::move(message));
    found_.back().problem.missing_type = true;
}

std::vector<Problem> ProblemList::sorted() const {
    std::vector<Found> ordered = found_;
    std::stable_sort(ordered.begin(), ordered.end(), [](const Found& a, const Found& b) {
        return std::tie(a.file, a.problem.line) < std::tie(b.file, b.problem.line);
    });
    std::vector<Problem> problems;
    problems.reserve(ordered.size());
    for (Found& found : ordered) problems.push_back(std::move(found.problem));
    return problems;
}

}  // namespace petal

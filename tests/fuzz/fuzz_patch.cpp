// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cstddef>
#include <cstdint>

#include "reader_properties.hpp"

namespace {

const std::string kBase = petal::pipeline_fakes::pipeline(
    {petal::pipeline_fakes::kScene, petal::pipeline_fakes::kFilter,
     R"("b": {"type": "detector.boards", "in": {"cloud": "clean.cloud", "images": "scene.images"}})",
     R"("k": {"type": "source.kinds", "params": {"count": 3, "texts": ["${out}"]}})",
     R"("m": {"type": "solver.mean", "in": {"poses": ["b.pose"]}})",
     R"("o": {"type": "sink.overlay", "in": {"pose": "m.pose"}})"});

const std::string kSeparator = "\n====\n";

}  // namespace

/// The input is the text of a patch; after a line `====` another one, at most three; those that
/// begin with a `=` are options --set.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    petal::pipeline_fakes::Input input{kBase, {}, {}};
    std::size_t begin = 0;
    for (int part = 0; part < 3 && begin != std::string::npos; ++part) {
        const std::size_t end = text.find(kSeparator, begin);
        const std::string piece = text.substr(begin, end == std::string::npos ? end : end - begin);
        if (!piece.empty() && piece.front() == '=') {
            input.sets.push_back(piece.substr(1));
        } else {
            input.patches.push_back(piece);
        }
        begin = end == std::string::npos ? end : end + kSeparator.size();
    }
    petal::fuzz::require_idempotent(petal::fuzz::read_and_check(input));
    return 0;
}

// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>

#include <set>

#include "built_plugins.hpp"
#include "catalogue.hpp"
#include "petal_process.hpp"

namespace petal::testing {
namespace {

class StagePage : public ::testing::TestWithParam<std::string> {};

TEST_P(StagePage, IsUpToDate) {
    const StageSpec* stage = built_plugins().registry.find(GetParam());
    const fs::path page = fs::path(PETAL_SOURCE_DIR) / "docs" / "stages" / (GetParam() + ".md");
    EXPECT_EQ(read_text(page), stage_markdown(*stage)) << "run scripts/update_docs.sh";
}

INSTANTIATE_TEST_SUITE_P(AllStages, StagePage, ::testing::ValuesIn(built_types()), test_name);

TEST(Documentation, HasNoPageOfAStageThatIsGone) {
    const auto types = built_types();
    const std::set<std::string> known(types.begin(), types.end());
    for (const auto& file : fs::directory_iterator(fs::path(PETAL_SOURCE_DIR) / "docs" / "stages"))
        EXPECT_EQ(known.count(file.path().stem().string()), 1U) << file.path();
}

TEST(Documentation, TheReadmesTableIsUpToDate) {
    const std::string readme = read_text(fs::path(PETAL_SOURCE_DIR) / "README.md");
    const std::string begin = "<!-- stages:begin -->\n";
    const std::size_t from = readme.find(begin);
    const std::size_t to = readme.find("<!-- stages:end -->");
    ASSERT_NE(from, std::string::npos);
    ASSERT_NE(to, std::string::npos);
    EXPECT_EQ(readme.substr(from + begin.size(), to - from - begin.size()),
              catalogue_markdown(built_plugins().registry.all(), "docs/stages"))
        << "run scripts/update_docs.sh";
}

TEST(Documentation, EveryPipelineStandsInItsTable) {
    const fs::path folder = fs::path(PETAL_SOURCE_DIR) / "pipelines";
    const std::string table = read_text(folder / "README.md");
    for (const auto& file : fs::recursive_directory_iterator(folder)) {
        if (file.path().extension() != ".json") continue;
        EXPECT_THAT(table, ::testing::HasSubstr(fs::relative(file.path(), folder).string()));
    }
}

}  // namespace
}  // namespace petal::testing

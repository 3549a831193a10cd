// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "loader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "cases.hpp"
#include "petal/error.hpp"

namespace petal {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::plugin_case;
using testing::plugin_file;
using ::testing::SizeIs;
using testing::TemporaryFolder;

std::string error_of(const std::function<void()>& act) {
    try {
        act();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

TEST(Loader, FillsInWhereAStageComesFrom) {
    const PluginSet set = load_plugins({plugin_case("good")});
    EXPECT_THAT(set.refused, IsEmpty());
    EXPECT_THAT(set.searched, ElementsAre(plugin_case("good")));
    ASSERT_THAT(set.loaded, SizeIs(1));
    EXPECT_EQ(set.loaded[0].library, fs::canonical(plugin_file("good")));
    EXPECT_EQ(set.loaded[0].name, "good");
    EXPECT_EQ(set.loaded[0].version, "1.2.3");
    EXPECT_THAT(set.loaded[0].types, ElementsAre("toys.good"));
    EXPECT_THAT(set.thread_limits, SizeIs(1));
    const StageSpec* stage = set.registry.find("toys.good");
    ASSERT_NE(stage, nullptr);
    EXPECT_EQ(stage->plugin, "good");
    EXPECT_EQ(stage->plugin_version, "1.2.3");
    EXPECT_EQ(stage->library, fs::canonical(plugin_file("good")).string());
    ASSERT_NE(stage->make_stage, nullptr);
    EXPECT_NE(stage->make_stage(stage->make_params().get()), nullptr);
}

struct Fault {
    const char* name;
    std::vector<std::string> says;
};
class RefusedPlugin : public ::testing::TestWithParam<Fault> {};

// Each library with one fault is refused for that fault, leaves nothing behind, and the next one
// loads.
TEST_P(RefusedPlugin, IsToldAndSkipped) {
    const Fault& fault = GetParam();
    if (!fs::exists(plugin_file(fault.name))) GTEST_SKIP() << "not built under a sanitizer";
    const PluginSet set = load_plugins({plugin_case(fault.name), plugin_case("good")});
    ASSERT_THAT(set.refused, SizeIs(1));
    EXPECT_EQ(set.refused[0].library, fs::canonical(plugin_file(fault.name)));
    for (const std::string& part : fault.says) EXPECT_THAT(set.refused[0].reason, HasSubstr(part));
    EXPECT_THAT(set.registry.types(), ElementsAre("toys.good"));
    EXPECT_THAT(set.loaded, SizeIs(1));
    EXPECT_THAT(set.thread_limits, SizeIs(1));
}

INSTANTIATE_TEST_SUITE_P(
    Loader, RefusedPlugin,
    ::testing::Values(
        Fault{
            "other_abi",
            {"was built differently", "framework ABI: plugin " + std::to_string(kFrameworkAbi + 1) +
                                          ", petal " + std::to_string(kFrameworkAbi)}},
        Fault{"other_alignment",
              {"was built differently", "Eigen alignment: plugin 64 bytes, petal"}},
        Fault{"old_strings", {"std::string ABI: plugin old (_GLIBCXX_USE_CXX11_ABI=0), petal new"}},
        Fault{"sanitized", {"sanitizers: plugin address, petal none"}},
        Fault{"no_library", {"is not a shared library: it has no ELF header"}},
        Fault{"no_record", {"no petal plugin", ".petal.plugin"}},
        Fault{"no_register", {"no function petal_plugin_register"}},
        Fault{"missing_symbol",
              {"cannot be opened: undefined symbol", "petal_test_function_of_nobody"}},
        Fault{"throws", {"while it registered its stages: the toy box is empty"}},
        Fault{"throws_int", {"no std::exception"}},
        Fault{"throws_in_describe", {"while it registered its stages: beyond words"}},
        Fault{"incomplete",
              {"stage 'toys.incomplete'", "parameter 'factor' is a double without a unit",
               "parameter 'factor' is a double without a range"}}),
    [](const auto& fault) { return std::string(fault.param.name); });

TEST(Loader, OneTypeInTwoLibrariesNamesBoth) {
    const std::string message = error_of([] {
        load_plugins({plugin_case("same_type_a"), plugin_case("same_type_b")});
    });
    EXPECT_THAT(message, AllOf(HasSubstr("'toys.same'"), HasSubstr("same_type_a/first.so"),
                               HasSubstr("same_type_b/second.so")));
}

TEST(Loader, ASurveyListsBothLibrariesOfAType) {
    const PluginSet set = survey_plugins(
        {plugin_case("same_type_a"), plugin_case("same_type_b"), plugin_case("good")});
    ASSERT_THAT(set.loaded, SizeIs(3));
    EXPECT_THAT(set.loaded[1].types, ElementsAre("toys.same"));
    EXPECT_THAT(set.registry.types(), ElementsAre("toys.good", "toys.same"));
    EXPECT_THAT(set.registry.find("toys.same")->library, HasSubstr("first.so"));
    EXPECT_THAT(set.clashes, ElementsAre(AllOf(HasSubstr("'toys.same'"), HasSubstr("first.so"),
                                               HasSubstr("second.so"))));
    EXPECT_THAT(set.refused, IsEmpty());
    EXPECT_THAT(survey_plugins({plugin_case("good")}).clashes, IsEmpty());
}

TEST(Loader, PacketTypesOfTheLastFolderAreTheReference) {
    const PluginSet set = load_plugins({plugin_case("types_1"), plugin_case("types_2")});
    EXPECT_THAT(set.registry.types(), ElementsAre("toys.user_2"));
    ASSERT_THAT(set.refused, SizeIs(1));
    EXPECT_EQ(set.refused[0].library.filename(), "user_1.so");
    EXPECT_THAT(set.refused[0].reason,
                HasSubstr("ABI of the library 'toys': plugin 1, petal's plugins 2"));
}

TEST(Loader, PacketTypesOfTheFirstPluginWhereTheLastFolderHasNone) {
    const PluginSet set =
        load_plugins({plugin_case("types_1"), plugin_case("types_2"), plugin_case("good")});
    EXPECT_THAT(set.registry.types(), ElementsAre("toys.good", "toys.user_1"));
    ASSERT_THAT(set.refused, SizeIs(1));
    EXPECT_EQ(set.refused[0].library.filename(), "user_2.so");
}

TEST(Loader, LoadsALibraryOnceHoweverManyNamesItHas) {
    const TemporaryFolder folder;
    fs::create_symlink(plugin_file("good"), folder.path() / "alias.so");
    fs::create_symlink(plugin_file("good"), folder.path() / "other.so");
    fs::create_symlink(plugin_file("good"), folder.path() / "other.so.1");
    const PluginSet set = load_plugins({folder.path(), plugin_case("good")});
    EXPECT_THAT(set.loaded, SizeIs(1));
    EXPECT_THAT(set.refused, IsEmpty());
}

TEST(Loader, ReadsNothingButFilesCalledSo) {
    const TemporaryFolder folder;
    folder.write("notes.txt", "no plugin");
    folder.write("libx.so.1", "no plugin");
    fs::create_directory(folder.path() / "folder.so");
    const PluginSet set = load_plugins({folder.path(), folder.path() / "absent"});
    EXPECT_THAT(set.loaded, IsEmpty());
    EXPECT_THAT(set.refused, IsEmpty());
}

TEST(Loader, TellsLinksThatLeadNowhereAndFoldersThatAreNone) {
    const TemporaryFolder folder;
    fs::create_symlink(folder.path() / "gone", folder.path() / "dangling.so");
    const fs::path file = folder.write("file", "");
    const PluginSet set = load_plugins({folder.path(), file});
    ASSERT_THAT(set.refused, SizeIs(2));
    EXPECT_EQ(set.refused[0].library.filename(), "dangling.so");
    EXPECT_THAT(set.refused[0].reason, HasSubstr("No such file"));
    EXPECT_EQ(set.refused[1].library, file);
    EXPECT_THAT(set.refused[1].reason, HasSubstr("folder cannot be read: Not a directory"));
}

TEST(Loader, TellsAFolderThatItMayNotRead) {
    if (::geteuid() == 0) GTEST_SKIP() << "root may read every folder";
    const TemporaryFolder folder;
    const fs::path locked = folder.path() / "locked";
    fs::create_directory(locked);
    fs::permissions(locked, fs::perms::none);
    const PluginSet set = load_plugins({locked});
    fs::permissions(locked, fs::perms::owner_all);
    ASSERT_THAT(set.refused, SizeIs(1));
    EXPECT_THAT(set.refused[0].reason, HasSubstr("Permission denied"));
}

class PluginFolders : public ::testing::Test {
   protected:
    PluginFolders() { ::unsetenv("PETAL_PLUGIN_PATH"); }
    ~PluginFolders() override { ::unsetenv("PETAL_PLUGIN_PATH"); }
    static void set_path(const std::string& text) {
        ::setenv("PETAL_PLUGIN_PATH", text.c_str(), 1);
    }
    const fs::path own_ = fs::canonical(fs::path(PETAL_BUILD_DIR) / "lib") / "petal";
};

TEST_F(PluginFolders, AreSearchedInOrder) {
    const TemporaryFolder folder;
    const fs::path a = folder.path() / "a";
    fs::create_directory(a);
    set_path("/nowhere/b:/nowhere/c");
    EXPECT_THAT(plugin_folders({a}), ElementsAre(a, "/nowhere/b", "/nowhere/c", own_));
}

TEST_F(PluginFolders, AreListedOnceAndTheOwnPlaceLast) {
    const TemporaryFolder folder;
    fs::create_directories(own_);
    set_path(own_.string() + ":" + folder.path().string() + "/");
    EXPECT_THAT(plugin_folders({folder.path() / "."}), ElementsAre(folder.path(), own_));
}

TEST_F(PluginFolders, AnEmptyVariableIsNone) {
    set_path("");
    EXPECT_THAT(plugin_folders({}), ElementsAre(own_));
}

TEST_F(PluginFolders, RefuseWhatDependsOnTheWorkingFolder) {
    set_path("/nowhere:plugins");
    EXPECT_THAT(error_of([] { plugin_folders({}); }), HasSubstr("the relative folder 'plugins'"));
    set_path("/nowhere:");
    EXPECT_THAT(error_of([] { plugin_folders({}); }), HasSubstr("empty element"));
}

TEST_F(PluginFolders, RefuseAGivenFolderThatIsNone) {
    EXPECT_THAT(error_of([] { plugin_folders({"/nowhere/a"}); }),
                HasSubstr("'/nowhere/a' (--plugin-path) does not exist"));
    EXPECT_THAT(error_of([] { plugin_folders({plugin_file("good")}); }),
                HasSubstr("is not a folder"));
}

}  // namespace
}  // namespace petal

// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <elf.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>
#include <functional>
#include <string>

#include "cases.hpp"
#include "loader.hpp"
#include "petal/error.hpp"

namespace petal {
namespace {

using ::testing::HasSubstr;
using testing::plugin_file;
using testing::read_bytes;
using testing::TemporaryFolder;

/// A good plugin's file, to be damaged.
class Record : public ::testing::Test {
   protected:
    /// What reading the changed file says; "no error" where it is read.
    std::string reading() const {
        try {
            read_plugin_record(folder_.write("changed.so", bytes_));
        } catch (const Error& error) {
            return error.what();
        }
        return "no error";
    }
    /// Offset of the record in the file.
    std::size_t record() const {
        for (auto at = bytes_.find("PETALPLG"); at != std::string::npos;
             at = bytes_.find("PETALPLG", at + 1)) {
            std::uint32_t size = 0;
            std::memcpy(&size, bytes_.data() + at + offsetof(PluginRecord, size), sizeof(size));
            if (size == sizeof(PluginRecord)) return at;
        }
        throw std::runtime_error("the good plugin has no record");
    }
    void put(std::size_t offset, std::uint32_t number) {
        std::memcpy(bytes_.data() + record() + offset, &number, sizeof(number));
    }

    const TemporaryFolder folder_;
    std::string bytes_ = read_bytes(plugin_file("good"));
};

TEST_F(Record, IsReadFromTheFile) {
    const PluginRecord record = read_plugin_record(plugin_file("good"));
    EXPECT_STREQ(record.name, "good");
    EXPECT_STREQ(record.version, "1.2.3");
    EXPECT_STREQ(record.types_name, "");
    EXPECT_EQ(record.framework_abi, kFrameworkAbi);
    EXPECT_EQ(mismatch(record, build_key()), "");
}

TEST_F(Record, OfAFileThatIsNotThere) {
    bytes_.clear();
    EXPECT_THAT(reading(), HasSubstr("has no ELF header"));
    try {
        read_plugin_record(folder_.path() / "absent.so");
        FAIL();
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("absent.so' cannot be read: No such file"));
    }
}

TEST_F(Record, OfAnotherKindOfElfFile) {
    bytes_[offsetof(Elf64_Ehdr, e_type)] = ET_REL;
    EXPECT_THAT(reading(), HasSubstr("not a shared library but another kind of ELF file"));
}

TEST_F(Record, OfAnotherMachine) {
    bytes_[offsetof(Elf64_Ehdr, e_machine)] = static_cast<char>(EM_SPARC);
    EXPECT_THAT(reading(), HasSubstr("for another machine: ELF machine 2 with 64 bits"));
}

TEST_F(Record, WithoutItsMagicWord) {
    bytes_[record()] = 'X';
    EXPECT_THAT(reading(), HasSubstr("does not start with PETALPLG"));
}

TEST_F(Record, OfAnotherSize) {
    put(offsetof(PluginRecord, size), 999);
    EXPECT_THAT(reading(), HasSubstr("another size: 999 bytes, petal expects 180"));
}

// The number of the framework's ABI says whether the rest means what we think, so it is told first.
TEST_F(Record, OfAnotherAbiAndSizeTellsTheAbi) {
    put(offsetof(PluginRecord, framework_abi), 999);
    put(offsetof(PluginRecord, size), 999);
    ASSERT_EQ(reading(), "no error");
    const PluginRecord read = read_plugin_record(folder_.path() / "changed.so");
    EXPECT_EQ(mismatch(read, build_key()),
              "framework ABI: plugin 999, petal " + std::to_string(kFrameworkAbi));
}

TEST_F(Record, WhoseTextNeverEnds) {
    const std::size_t at = record() + offsetof(PluginRecord, name);
    bytes_.replace(at, sizeof(PluginRecord::name), sizeof(PluginRecord::name), 'x');
    EXPECT_THAT(reading(), HasSubstr("are not text"));
}

// A copy that broke off is refused wherever it broke off: the section table is the end of the file.
TEST_F(Record, OfACutFile) {
    const std::string whole = bytes_;
    for (std::size_t i = 0; i < 50; ++i) {
        bytes_ = whole.substr(0, whole.size() * i / 50);
        EXPECT_THAT(reading(),
                    ::testing::AnyOf(HasSubstr("no ELF header"), HasSubstr("damaged or cut off"),
                                     HasSubstr("not a shared library")))
            << bytes_.size() << " of " << whole.size() << " bytes";
    }
}

// Any single byte of the header or the section table may be wrong: an error or a record, never a
// crash.
TEST_F(Record, OfAFileWithAWrongByte) {
    const std::string whole = bytes_;
    Elf64_Ehdr header{};
    std::memcpy(&header, whole.data(), sizeof(header));
    std::size_t errors = 0;
    const auto spoil = [&](std::size_t at) {
        bytes_ = whole;
        bytes_[at] = static_cast<char>(~bytes_[at]);
        if (reading() != "no error") ++errors;
    };
    for (std::size_t at = 0; at < sizeof(header); ++at) spoil(at);
    for (std::size_t at = header.e_shoff; at < whole.size(); ++at) spoil(at);
    EXPECT_GT(errors, 0U);
}

}  // namespace
}  // namespace petal

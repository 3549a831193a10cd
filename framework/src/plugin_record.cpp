// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <fcntl.h>
#include <gelf.h>
#include <libelf.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <optional>
#include <string>

#include "loader.hpp"
#include "petal/error.hpp"
#include "plugin_record.hpp"

namespace petal {
namespace {

const char* const kSection = ".petal.plugin";
/// Magic, size and framework ABI keep their places for ever: they tell whether the rest can be
/// read.
constexpr std::size_t kPrefix = offsetof(PluginRecord, types_abi);

/// An ELF file open for reading.
class ElfFile {
   public:
    /// \throws Error, told without the file's name, when the file cannot be read or is no ELF file.
    explicit ElfFile(const std::filesystem::path& path)
        : fd_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
        if (fd_ < 0) throw Error(std::string("cannot be read: ") + std::strerror(errno));
        if (elf_version(EV_CURRENT) != EV_NONE) elf_ = elf_begin(fd_, ELF_C_READ, nullptr);
        if (elf_ == nullptr || elf_kind(elf_) != ELF_K_ELF ||
            gelf_getehdr(elf_, &header_) == nullptr) {
            close();
            throw Error("is not a shared library: it has no ELF header");
        }
    }
    ElfFile(const ElfFile&) = delete;
    ElfFile& operator=(const ElfFile&) = delete;
    ~ElfFile() { close(); }

    const GElf_Ehdr& header() const { return header_; }

    /// The bytes of a section; nothing where there is none of that name.
    /// \throws Error where the section table lies outside the file.
    std::optional<std::string> section(const std::string& name) const {
        std::size_t names = 0;
        std::size_t count = 0;
        if (elf_getshdrnum(elf_, &count) != 0 || elf_getshdrstrndx(elf_, &names) != 0) throw cut();
        // libelf answers a cut file with an empty table where the header promises one.
        if (count == 0 && header_.e_shoff != 0) throw cut();
        for (std::size_t i = 1; i < count; ++i) {
            Elf_Scn* const section = elf_getscn(elf_, i);
            GElf_Shdr info{};
            if (section == nullptr || gelf_getshdr(section, &info) == nullptr) throw cut();
            const char* const found = elf_strptr(elf_, names, info.sh_name);
            if (found == nullptr) throw cut();
            if (name != found) continue;
            const Elf_Data* const data = elf_rawdata(section, nullptr);
            if (data == nullptr) throw cut();
            if (data->d_buf == nullptr) return std::string();
            return std::string(static_cast<const char*>(data->d_buf), data->d_size);
        }
        return std::nullopt;
    }

   private:
    static Error cut() {
        return Error(
            "is damaged or cut off: its ELF section table cannot be read; copy or build it again");
    }
    void close() {
        if (elf_ != nullptr) elf_end(elf_);
        if (fd_ >= 0) ::close(fd_);
        elf_ = nullptr;
        fd_ = -1;
    }

    int fd_ = -1;
    Elf* elf_ = nullptr;
    GElf_Ehdr header_{};
};

/// Class, byte order and machine of this process.
const GElf_Ehdr& host_header() {
    static const GElf_Ehdr header = ElfFile("/proc/self/exe").header();
    return header;
}

void check_machine(const GElf_Ehdr& header) {
    if (header.e_type != ET_DYN)
        throw Error("is not a shared library but another kind of ELF file (type " +
                    std::to_string(header.e_type) + ")");
    const GElf_Ehdr& host = host_header();
    const auto bits = [](const GElf_Ehdr& h) {
        return h.e_ident[EI_CLASS] == ELFCLASS64 ? "64" : "32";
    };
    if (header.e_machine != host.e_machine || header.e_ident[EI_CLASS] != host.e_ident[EI_CLASS] ||
        header.e_ident[EI_DATA] != host.e_ident[EI_DATA])
        throw Error(std::string("is a shared library for another machine: ELF machine ") +
                    std::to_string(header.e_machine) + " with " + bits(header) +
                    " bits, petal runs on " + std::to_string(host.e_machine) + " with " +
                    bits(host));
}

template <std::size_t N>
bool is_text(const char (&text)[N]) {
    return std::find(std::begin(text), std::end(text), '\0') != std::end(text);
}

PluginRecord parse(const std::string& bytes) {
    const std::string size = std::to_string(bytes.size());
    if (bytes.size() < kPrefix)
        throw Error("has a plugin record that is cut off after " + size + " bytes");
    PluginRecord record{};
    std::memcpy(&record, bytes.data(), kPrefix);
    if (std::memcmp(record.magic, "PETALPLG", sizeof(record.magic)) != 0)
        throw Error(std::string("has a section ") + kSection +
                    " that does not start with PETALPLG");
    // Another ABI may lay out the rest differently: mismatch() tells the number, nothing else is
    // read.
    if (record.framework_abi != kFrameworkAbi) return record;
    if (record.size != sizeof(PluginRecord))
        throw Error("has a plugin record of another size: " + std::to_string(record.size) +
                    " bytes, petal expects " + std::to_string(sizeof(PluginRecord)));
    if (bytes.size() != sizeof(PluginRecord))
        throw Error("has a plugin record that says " + std::to_string(record.size) +
                    " bytes, but " + size + " are there");
    std::memcpy(&record, bytes.data(), sizeof(PluginRecord));
    if (!is_text(record.types_name) || !is_text(record.name) || !is_text(record.version) ||
        record.name[0] == '\0')
        throw Error("has a plugin record whose name, version or types are not text");
    return record;
}

}  // namespace

PluginRecord read_record(const std::filesystem::path& library) {
    const ElfFile file(library);
    check_machine(file.header());
    const auto bytes = file.section(kSection);
    if (!bytes)
        throw Error(std::string("is a shared library but no petal plugin: it has no section ") +
                    kSection + " (PETAL_PLUGIN writes it)");
    return parse(*bytes);
}

PluginRecord read_plugin_record(const std::filesystem::path& library) {
    try {
        return read_record(library);
    } catch (const Error& error) {
        throw Error("'" + library.string() + "' " + error.what());
    }
}

}  // namespace petal

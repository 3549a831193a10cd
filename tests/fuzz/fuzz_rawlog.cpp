// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

// Any bytes as a rawlog: they are read to the end, the inventory is made of them (and with it the
// points of each LiDAR), and nothing but petal::Error comes out.

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <string>

#include "petal/error.hpp"
#include "petal/rawlog/inventory.hpp"
#include "petal/rawlog/rawlog_reader.hpp"

/// What is to take the place of a function of the system for the libraries too.
#define SEEN_BY_MRPT __attribute__((visibility("default")))

// What MRPT allocates for a class whose counts petal does not know (ClaimCheck) may be anything;
// that it is refused is what a user without that much memory sees, and it must come out as an
// Error.
constexpr std::size_t kMostBytes = std::size_t{512} << 20U;

extern "C" const char* __asan_default_options() {
    return "alloc_dealloc_mismatch=0:allocator_may_return_null=1:max_allocation_size_mb=512";
}

/// MRPT forgets a message of a GPS when reading the next part of it throws: nothing that a reader
/// of its observations could free.
extern "C" const char* __lsan_default_suppressions() {
    return "leak:mrpt::obs::CObservationGPS::serializeFrom\n";
}

void* operator new(std::size_t size) {
    void* memory = size > kMostBytes ? nullptr : std::malloc(size);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}

/// MRPT puts a call stack into each of its exceptions, which takes 50 ms.
extern "C" SEEN_BY_MRPT int backtrace(void**, int) {
    return 0;
}

namespace {

void require(bool holds, const char* what) {
    if (holds) return;
    std::fprintf(stderr, "broken: %s\n", what);
    std::abort();
}

/// A file without a disk; the same one for all inputs.
class MemoryFile {
   public:
    MemoryFile() : descriptor_(memfd_create("rawlog", 0)) {
        require(descriptor_ >= 0, "memfd_create");
    }
    std::string hold(const std::uint8_t* data, std::size_t size) const {
        require(ftruncate(descriptor_, 0) == 0, "ftruncate");
        require(pwrite(descriptor_, data, size, 0) == static_cast<ssize_t>(size), "pwrite");
        return "/proc/self/fd/" + std::to_string(descriptor_);
    }

   private:
    int descriptor_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const MemoryFile file;
    const std::string path = file.hold(data, size);
    petal::RawlogInventory inventory;
    try {
        petal::RawlogReader reader(path);
        const auto load = [&](mrpt::obs::CObservation& observation) { reader.load(observation); };
        std::size_t objects = 0;
        while (const auto object = reader.next_object()) {
            require(reader.objects() > objects, "an object that is read is counted");
            objects = reader.objects();
            inventory.add(*object, load);
        }
        require(reader.stream().failure().empty(), "an end is either sound or told");
    } catch (const petal::Error& e) {
        require(std::string(e.what()).find("/proc/self/fd/") != std::string::npos,
                "a message names the file");
    }
    for (const auto& [key, sensor] : inventory.sensors()) {
        require(sensor.messages > 0, "a sensor has a message");
        require(sensor.stamps.unknown() <= sensor.messages, "stamps are those of messages");
    }
    return 0;
}

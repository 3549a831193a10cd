// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "jpeg_check.hpp"

#include <array>
#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>

#include <jpeglib.h>

namespace petal {
namespace {

/// More pixels than this are damage: libjpeg makes room for all of a progressive picture.
constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 28U;

/// libjpeg's handler of errors, which must not return: it jumps back to where the look began.
struct Trap {
    jpeg_error_mgr manager;  // first: libjpeg hands out its address
    std::jmp_buf back;
    std::array<char, JMSG_LENGTH_MAX> message;
};

[[noreturn]] void spring(j_common_ptr jpeg) {
    auto* trap = reinterpret_cast<Trap*>(jpeg->err);
    jpeg->err->format_message(jpeg, trap->message.data());
    std::longjmp(trap->back, 1);
}

void stay_silent(j_common_ptr) {}

/// Whether a marker stands in a picture's data, other than that of the end as the last two bytes.
/// FF 00 is a data byte, FF D0 to FF D7 restart the decoder, FF FF is filling.
bool has_marker(const unsigned char* data, std::size_t count) {
    const unsigned char* const end = data + count;
    while (data < end) {
        const auto* at = static_cast<const unsigned char*>(
            std::memchr(data, 0xFF, static_cast<std::size_t>(end - data)));
        if (at == nullptr || at + 1 == end) return false;
        if (at + 2 == end && at[1] == 0xD9) return false;
        if (at[1] != 0x00 && at[1] != 0xFF && (at[1] < 0xD0 || at[1] > 0xD7)) return true;
        data = at + 1;
    }
    return false;
}

/// Decodes the picture an eighth as large: all that can go wrong does.
void decode_small(jpeg_decompress_struct& jpeg, JSAMPROW row) {
    while (jpeg.output_scanline < jpeg.output_height) jpeg_read_scanlines(&jpeg, &row, 1);
    jpeg_finish_decompress(&jpeg);
}

/// The look itself. Nothing in here has a destructor: errors jump over it.
void look(jpeg_decompress_struct& jpeg, const unsigned char* bytes, std::size_t count, JSAMPLE* row,
          bool& too_large) {
    jpeg_create_decompress(&jpeg);
    jpeg_mem_src(&jpeg, bytes, static_cast<unsigned long>(count));
    jpeg_read_header(&jpeg, TRUE);
    too_large = std::uint64_t{jpeg.image_width} * jpeg.image_height > kMostPixels;
    if (too_large) return;
    jpeg.scale_num = 1;
    jpeg.scale_denom = 8;
    jpeg_start_decompress(&jpeg);
    const bool all_read = jpeg_has_multiple_scans(&jpeg) != FALSE;
    if (!all_read && has_marker(jpeg.src->next_input_byte, jpeg.src->bytes_in_buffer))
        decode_small(jpeg, row);
}

}  // namespace

std::string jpeg_problem(const void* bytes, std::size_t count) {
    // A row of an eighth of the widest picture, of four components.
    constexpr std::size_t kWidestRow = (JPEG_MAX_DIMENSION / 8 + 1) * 4;
    const auto row = std::make_unique<JSAMPLE[]>(kWidestRow);
    const auto trap = std::make_unique<Trap>();
    const auto jpeg = std::make_unique<jpeg_decompress_struct>();
    const auto too_large = std::make_unique<bool>(false);
    jpeg->err = jpeg_std_error(&trap->manager);
    trap->manager.error_exit = spring;
    trap->manager.output_message = stay_silent;
    const bool failed = setjmp(trap->back) != 0;
    if (!failed)
        look(*jpeg, static_cast<const unsigned char*>(bytes), count, row.get(), *too_large);
    jpeg_destroy_decompress(jpeg.get());
    if (failed) return trap->message.data();
    if (*too_large)
        return std::to_string(jpeg->image_width) + " x " + std::to_string(jpeg->image_height) +
               " pixels, which no image has";
    return {};
}

}  // namespace petal

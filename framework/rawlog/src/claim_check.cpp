// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/rawlog/claim_check.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <regex>
#include <utility>

#include "jpeg_check.hpp"
#include "rawlog_class.hpp"

namespace petal {
namespace {

// More than this in one field of one object is damage, however large the file is: 89 million
// points, or an image of 19000 x 19000 pixels.
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30U;
// Claims below are not worth a look.
constexpr std::uint64_t kSmall = std::uint64_t{1} << 16U;

/// How the last read, or the last two, are to be understood.
enum class Meaning {
    count,      ///< so many elements follow
    made,       ///< MRPT makes so many elements, of which the file holds none
    area,       ///< rows and columns: so many elements follow
    raw_image,  ///< width and height, both negative where the pixels follow as they are
};

/// A place where a count stands.
struct Place {
    const char* outer;    ///< class of the object; "" for any
    const char* last;     ///< class of the last header
    const char* reads;    ///< the sizes since, the count's own included; see expression()
    std::uint64_t bytes;  ///< of an element in the file, at least
    Meaning meaning;
    int from_version = 0;  ///< of the class of the object; where that is any, of the last header
    int to_version = 255;
};

constexpr std::array kPlaces = {
    Place{"", "CSimplePointsMap", "4", 12, Meaning::count},
    Place{"", "CPointsMapXYZI", "4", 12, Meaning::count},
    Place{"", "CColouredPointsMap", "4", 12, Meaning::count},
    Place{"", "CColouredPointsMap", "(0|4...)v?v?4", 4, Meaning::count, 8},  // colours
    Place{"", "CColouredPointsMap", "(0|4....?)x1{5,6}x1xv?v?v?4", 4, Meaning::count, 0, 7},
    Place{"", "CWeightedPointsMap", "4", 12, Meaning::count},
    Place{"CObservationPointCloud", "CObservationPointCloud", "4", 1, Meaning::count},  // label
    Place{"CObservationPointCloud", "CPose3D", "8+114", 1, Meaning::count},  // external file
    Place{"CObservation2DRangeScan", "CPose3D", "8+14", 4, Meaning::count},
    Place{"CObservation2DRangeScan", "CPose3D", "8+1(0|4..)x8x4", 1, Meaning::count},  // label
    Place{"CObservation3DRangeScan", "CPose3D", "8+114", 12, Meaning::count},
    Place{"CObservation3DRangeScan", "CPose3D", "8+11(x|x.....)?1xxx", 2, Meaning::area},
    // After the second pose: label and names of external files, labels of pixels, other layers.
    Place{"CObservation3DRangeScan", "CPose3D", "8+1x8(v1){0,2}4", 1, Meaning::count},
    Place{"CObservation3DRangeScan", "CPose3D", "8+1x8v1v1v11111xx", 1, Meaning::area},
    Place{"CObservation3DRangeScan", "CPose3D", "8+1x8v1v1v1111l*4", 1, Meaning::count},
    Place{"CObservation3DRangeScan", "CPose3D", "8+1x8v1v1v1111l*vxx", 2, Meaning::area},
    Place{"CObservationVelodyneScan", "CObservationVelodyneScan", "84", 1, Meaning::count},
    Place{"CObservationVelodyneScan", "CPose3D", "8+14", 1206, Meaning::count},  // packets
    Place{"CObservationVelodyneScan", "CPose3D", "8+1v4", 72, Meaning::count},   // calibration
    Place{"CObservationVelodyneScan", "CPose3D", "8+1vvv?v?v?4", 1, Meaning::count},
    Place{"CObservationRotatingScan", "CObservationRotatingScan", "84", 1, Meaning::count},
    Place{"CObservationRotatingScan", "CObservationRotatingScan", "8v2288884", 1, Meaning::count},
    Place{"CObservationRotatingScan", "CPose3D", "8+18122", 2, Meaning::area},
    Place{"CObservationRotatingScan", "CPose3D", "8+18122.?22", 1, Meaning::area},
    Place{"CObservationRotatingScan", "CPose3D", "8+18122.?22.?2(v.)*4", 1, Meaning::count},
    Place{"", "CImage", "11x4", 3, Meaning::raw_image},
    Place{"", "CImage", "11xx4", 1, Meaning::count},                              // a JPEG's bytes
    Place{"", "CImage", "11xxx4", 1, Meaning::count},                             // grey pixels
    Place{"", "CImage", "14", 1, Meaning::count},                                 // external file
    Place{"CObservationImage", "CImage", "1.*184", 1, Meaning::count},            // label
    Place{"CObservationStereoImages", "CPose3DQuat", "8+14", 1, Meaning::count},  // label
    Place{"CObservationOdometry", "CPose2D", "8+14", 1, Meaning::count},          // label
    Place{"CObservationIMU", "CPose3D", "8+1.8.4", 1, Meaning::count},            // label
    Place{"CObservationComment", "CObservationComment", "4", 1, Meaning::count},
    Place{"", "CObservationGasSensors", "4", 4, Meaning::count},
    Place{"", "TCamera", "8+xx4", 1, Meaning::count},  // name
    Place{"", "CMatrixD", "x4", 8, Meaning::area},
    Place{"", "CMatrixF", "x4", 4, Meaning::area},
    // After a pose of the old format, which holds a matrix.
    Place{"CObservation2DRangeScan", "CMatrixD", "xx.114", 4, Meaning::count},
    Place{"", "CPosePDFParticles", "4", 24, Meaning::count},
    Place{"", "CPosePDFSOG", "4", 24, Meaning::count},
    Place{"", "CPose3DPDFParticles", "4", 24, Meaning::count},
    Place{"", "CPose3DPDFSOG", "4", 24, Meaning::count},
    // Particles of a movement by the model of Thrun: 300 is usual, a million is too many.
    Place{"CActionRobotMovement2D", "CPose2D", "8+1x{7}4", 1024, Meaning::made, 4},
    Place{"CActionRobotMovement2D", "CPose2D", "8+1xxxx884", 1024, Meaning::made, 0, 3},
    Place{"", "CSimpleMap", "4", 4, Meaning::count},
    Place{"", "CSensoryFrame", "4", 2, Meaning::count, 2},
    Place{"", "CSensoryFrame", "x?84", 2, Meaning::count, 0, 1},
    Place{"", "CActionCollection", "4", 2, Meaning::count},
};

/// Of a read: its size, 0 for four bytes that are zero, n for any other size.
char token(const void* bytes, std::size_t count) {
    constexpr std::array<char, 4> kZero = {};
    if (count == 4 && std::memcmp(bytes, kZero.data(), 4) == 0) return '0';
    return count == 1 || count == 2 || count == 4 || count == 8 ? static_cast<char>('0' + count)
                                                                : 'n';
}

std::string without_namespace(const std::string& name) {
    const std::size_t colons = name.rfind("::");
    return colons == std::string::npos ? name : name.substr(colons + 2);
}

/// A place's reads are a regular expression of tokens, in which stand
///     x  for any four bytes,
///     v  for a vector: a count and its elements, or 0 and none,
///     l  for a layer of an image: a name, rows, columns, and the pixels where there are any.
std::regex expression(std::string reads) {
    for (const auto& [letter, meaning] :
         {std::pair("l", "(?:v(?:0x|40|44.))"), std::pair("v", "(?:0|4.)"), std::pair("x", "[04]")})
        reads = std::regex_replace(reads, std::regex(letter), meaning);
    return std::regex(reads);
}

bool matches(const std::string& reads, std::size_t place) {
    static const auto kAll = [] {
        std::array<std::regex, kPlaces.size()> all;
        for (std::size_t i = 0; i < all.size(); ++i) all[i] = expression(kPlaces[i].reads);
        return all;
    }();
    return std::regex_match(reads, kAll[place]);
}

/// Elements that the last reads claim.
std::uint64_t claimed(Meaning meaning, std::uint32_t previous, std::uint32_t value) {
    if (meaning == Meaning::count || meaning == Meaning::made) return value;
    // MRPT takes its time for many rows of no columns too.
    if (meaning == Meaning::area)
        return std::max<std::uint64_t>({std::uint64_t{previous} * value, previous, value});
    const auto width = static_cast<std::int32_t>(previous);
    const auto height = static_cast<std::int32_t>(value);
    if (width >= 0 || height >= 0) return 0;
    return static_cast<std::uint64_t>(-std::int64_t{width}) *
           static_cast<std::uint64_t>(-std::int64_t{height});
}

}  // namespace

void ClaimCheck::begin_object() {
    outer_.clear();
    last_.clear();
    reads_.clear();
    problem_.clear();
    name_length_ = 0;
    version_next_ = false;
}

bool ClaimCheck::is_header(const void* bytes, std::size_t count) {
    if (version_next_) {
        version_next_ = false;
        last_version_ = *static_cast<const unsigned char*>(bytes);
        if (outer_ == last_) outer_version_ = last_version_;
        return count == 1 || count == 4;  // 4 before 2008
    }
    if (name_length_ == 0 || count != name_length_) return false;
    // MRPT ends the name at a NUL.
    std::string name(static_cast<const char*>(bytes), count);
    name.resize(std::min(name.size(), name.find('\0')));
    // An end flag (0x88) and a number of eight bytes may look like a header too.
    const mrpt::rtti::TRuntimeClassId* known = mrpt::rtti::findRegisteredClass(name);
    if (known == nullptr) return false;
    name = without_namespace(known->className);
    if (outer_.empty() && !stands_in_rawlogs(*known)) problem_ = "it is a " + name;
    // MRPT reads a distribution there unless the method is odometry (0), and does not look whether
    // it got one.
    // ("41": the method, and the length of this name.)
    if (last_ == "CActionRobotMovement2D" && reads_ == "41" && value_ != 0 &&
        name.find("PDF") == std::string::npos)
        problem_ = "a movement estimated by method " + std::to_string(value_) + " has a " + name +
                   " for its distribution";
    last_ = name;
    // Of what can hold observations or actions, the observation or action counts.
    if (last_.rfind("CObservation", 0) == 0 || last_.rfind("CAction", 0) == 0 || outer_.empty())
        outer_ = last_;
    reads_.clear();
    version_next_ = true;
    name_length_ = 0;
    return true;
}

bool ClaimCheck::is_jpeg(std::size_t count) const {
    // Two flags, width, height, and the number of bytes, which follow in one read. (Grey pixels as
    // they are have one number more between; four bytes are no JPEG.)
    return last_ == "CImage" && reads_.size() == 5 && reads_.compare(0, 2, "11") == 0 &&
           (reads_[3] == '4' || reads_[3] == '0') && reads_[4] == '4' && count == value_ &&
           count > 4;
}

std::string ClaimCheck::after_read(const void* bytes, std::size_t count, std::uint64_t can_follow) {
    if (is_header(bytes, count)) return problem_;
    // A header is the length of the name, with a flag; before 2008 without, and of four bytes.
    name_length_ = 0;
    if (count == 1) {
        const auto byte = *static_cast<const unsigned char*>(bytes);
        if (byte > 0x80U) name_length_ = byte & 0x7FU;
        old_length_ = byte;
    } else if (count == 3) {
        name_length_ = old_length_;
    }
    constexpr std::size_t kMostReads = 1100;  // 255 layers; no count of ours stands further on
    if (last_.empty() || reads_.size() > kMostReads) return {};
    if (is_jpeg(count))
        if (const std::string problem = jpeg_problem(bytes, count); !problem.empty())
            return "an image in it is no JPEG that can be decoded (" + problem + ")";
    reads_ += token(bytes, count);
    if (count != 2 && count != 4) return {};
    previous_ = value_;
    value_ = 0;
    std::memcpy(&value_, bytes, count);  // rawlogs are little endian, as all that petal runs on
    if (value_ < kSmall && previous_ < kSmall && std::uint64_t{value_} * previous_ < kSmall)
        return {};
    for (std::size_t i = 0; i < kPlaces.size(); ++i) {
        const Place& place = kPlaces[i];
        if (last_ != place.last || (*place.outer != 0 && outer_ != place.outer)) continue;
        const int version = *place.outer != 0 ? outer_version_ : last_version_;
        if (version < place.from_version || version > place.to_version) continue;
        if (!matches(reads_, i)) continue;
        const std::uint64_t elements = claimed(place.meaning, previous_, value_);
        if (place.meaning != Meaning::made && elements > can_follow / place.bytes)
            return "it claims " + std::to_string(elements) + " elements of " +
                   std::to_string(place.bytes) + " bytes or more, but at most " +
                   std::to_string(can_follow) + " bytes can follow";
        if (elements > kMostBytes / place.bytes)
            return "it claims " + std::to_string(elements) + " elements of " +
                   std::to_string(place.bytes) + " bytes or more, which no single object has";
    }
    return {};
}

}  // namespace petal

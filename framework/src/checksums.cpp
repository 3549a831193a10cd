// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "checksums.hpp"

#include <openssl/evp.h>

#include <array>
#include <fstream>
#include <memory>
#include <vector>

#include "petal/error.hpp"

namespace petal {

namespace {

const char* const kNotComputed = "not computed: the run was cancelled";

std::string hexadecimal(const unsigned char* bytes, std::size_t count) {
    static constexpr char kDigits[] = "0123456789abcdef";
    std::string text;
    for (std::size_t i = 0; i < count; ++i) {
        text += kDigits[bytes[i] >> 4];
        text += kDigits[bytes[i] & 15];
    }
    return text;
}

/// BLAKE2b of what is added piece by piece.
class Digest {
   public:
    Digest() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
        EVP_DigestInit_ex(context_.get(), EVP_blake2b512(), nullptr);
    }
    void add(const char* bytes, std::size_t count) {
        EVP_DigestUpdate(context_.get(), bytes, count);
    }
    std::string finish() {
        std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
        unsigned int length = 0;
        EVP_DigestFinal_ex(context_.get(), digest.data(), &length);
        return hexadecimal(digest.data(), length);
    }

   private:
    std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

std::string hash_of(const std::filesystem::path& file, const std::atomic<bool>* cancel,
                    const std::atomic<bool>* abandoned) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw Error("cannot read " + file.string() + " for its checksum");
    Digest digest;
    std::vector<char> block(1 << 17);
    while (in) {
        for (const auto* stop : {cancel, abandoned})
            if (stop != nullptr && stop->load()) throw Cancelled();
        in.read(block.data(), static_cast<std::streamsize>(block.size()));
        digest.add(block.data(), static_cast<std::size_t>(in.gcount()));
    }
    if (in.bad()) throw Error("reading " + file.string() + " for its checksum failed half-way");
    return digest.finish();
}

}  // namespace

std::string blake2b_of(const std::filesystem::path& file, const std::atomic<bool>* cancel) {
    return hash_of(file, cancel, nullptr);
}

std::string blake2b_of_text(std::string_view text) {
    Digest digest;
    digest.add(text.data(), text.size());
    return digest.finish();
}

Checksums::Checksums(const std::atomic<bool>* cancel, bool while_running) : cancel_(cancel) {
    if (while_running) thread_ = std::thread([this] { work(); });
}

Checksums::~Checksums() {
    abandoned_ = true;
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        no_more_ = true;
    }
    more_.notify_one();
    if (thread_.joinable()) thread_.join();
}

void Checksums::add(const std::filesystem::path& file) {
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (!sums_.emplace(file, Checksum{"", kNotComputed}).second) return;
        waiting_.push_back(file);
    }
    more_.notify_one();
}

std::map<std::filesystem::path, Checksum> Checksums::finish() {
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        no_more_ = true;
    }
    more_.notify_one();
    if (thread_.joinable())
        thread_.join();
    else
        work();
    return std::move(sums_);
}

void Checksums::work() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (true) {
        more_.wait(lock, [this] { return no_more_ || !waiting_.empty(); });
        if (waiting_.empty()) return;
        const std::filesystem::path file = waiting_.front();
        waiting_.pop_front();
        lock.unlock();
        Checksum sum;
        try {
            sum.blake2b = hash_of(file, cancel_, &abandoned_);
        } catch (const Cancelled&) {
            return;  // it and those that wait stay without one
        } catch (const std::exception& error) {
            sum.missing = error.what();
        }
        lock.lock();
        sums_[file] = sum;
    }
}

}  // namespace petal

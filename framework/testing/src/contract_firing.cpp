// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "contract_firing.hpp"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "firing.hpp"
#include "petal/error.hpp"
#include "petal/testing/stage_harness.hpp"

namespace petal::testing {

namespace fs = std::filesystem;

namespace {

std::map<std::string, std::string> files_below(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file()) continue;
        std::ifstream in(entry.path(), std::ios::binary);
        files[fs::relative(entry.path(), folder).string()] = {std::istreambuf_iterator<char>(in),
                                                              std::istreambuf_iterator<char>()};
    }
    return files;
}

std::string told_by(const StageHarness& harness, const ContractInputs& inputs) {
    std::string told;
    for (const PortSpec& port : harness.spec().outputs)
        for (const AnyPacket& packet : harness.written(port.name))
            told += port.name + ":" + content_of(inputs, packet) + "\n";
    for (const Note& note : harness.notes())
        told += "note:" + note.looked_for + "|" + note.nearest_miss + "|" + note.threshold + "|" +
                note.hint + "\n";
    if (harness.verdict()) told += std::string("verdict:") + to_string(*harness.verdict()) + "\n";
    for (const std::string& reason : harness.reasons()) told += "reason:" + reason + "\n";
    return told;
}

/// Two frames where the stage fires frame by frame; once wires carry one packet.
void give(StageHarness& harness, const GivenPackets& given) {
    const bool gathers = harness.spec().gathers();
    for (const auto& [port, packet] : given) {
        const bool twice = !gathers || harness.spec().find_input(port)->gathers;
        for (std::uint64_t number = 0; number < (twice ? 2U : 1U); ++number) {
            AnyPacket one = packet;
            one.frame = std::make_shared<const FrameInfo>(
                FrameInfo{number, "frame" + std::to_string(number), 0.0});
            harness.give_packet(port, std::move(one));
        }
    }
}

void fire(StageHarness& harness, FiringOutcome& outcome) {
    try {
        harness.fire();
    } catch (const Cancelled&) {
        outcome.end = FiringOutcome::End::cancelled;
    } catch (const StageFault& fault) {
        outcome.end = FiringOutcome::End::broke;
        outcome.message = fault.what();
    } catch (const Error& error) {
        outcome.end = FiringOutcome::End::refused;
        outcome.message = error.what();
    } catch (const std::exception& error) {
        outcome.end = FiringOutcome::End::broke;
        outcome.message = std::string("threw what is no petal::Error: ") + error.what();
    } catch (...) {
        outcome.end = FiringOutcome::End::broke;
        outcome.message = "threw what is no std::exception";
    }
}

}  // namespace

std::string content_of(const ContractInputs& inputs, const AnyPacket& packet) {
    const auto found = inputs.contents.find(packet.type);
    return found == inputs.contents.end() ? std::to_string(packet.bytes) : found->second(packet);
}

FiringOutcome fire_once(const StageSpec& spec, const ContractInputs& inputs,
                        const GivenPackets& given, const FiringWay& way) {
    StageHarness harness(spec);
    if (const auto own = inputs.params.find(spec.type); own != inputs.params.end())
        for (const auto& [name, value] : own->second) harness.set(name, value);
    for (const auto& [name, value] : way.params) harness.set(name, value);
    harness.threads(way.threads).change_threads(way.change_threads);
    if (way.cancelled) harness.cancel();
    if (way.cancel_after_s > 0.0) harness.cancel_after(way.cancel_after_s);
    give(harness, given);

    FiringOutcome outcome;
    const auto start = std::chrono::steady_clock::now();
    fire(harness, outcome);
    outcome.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    outcome.told = told_by(harness, inputs);
    outcome.files = files_below(harness.folder());
    // Every run has a folder of its own; a message that names it is no other message.
    const std::string folder = harness.folder().string();
    for (std::string* text : {&outcome.message, &outcome.told})
        for (std::size_t at = text->find(folder); at != std::string::npos; at = text->find(folder))
            text->replace(at, folder.size(), "FOLDER");
    return outcome;
}

}  // namespace petal::testing

// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plugin_opening.hpp"

#include <dlfcn.h>

#include <exception>
#include <string>
#include <utility>

#include "petal/error.hpp"
#include "plugin_record.hpp"
#include "registry.hpp"

namespace petal {
namespace {

/// Takes what one library registers, so that a library which fails half-way leaves nothing behind.
class Collector final : public Registrar {
   public:
    explicit Collector(OpenedPlugin& opened) : opened_(opened) {}
    void on_thread_limit(std::function<void(int threads)> apply) override {
        if (!apply) throw Error("on_thread_limit was given an empty function");
        opened_.thread_limits.push_back(std::move(apply));
    }
    const Registry& registry() const { return registry_; }

   protected:
    void add_spec(StageSpec spec) override {
        spec.plugin = opened_.plugin.name;
        spec.plugin_version = opened_.plugin.version;
        spec.library = opened_.plugin.library.string();
        registry_.add(std::move(spec));
    }

   private:
    OpenedPlugin& opened_;
    Registry registry_;
};

/// What dlerror() says, without the library's name in front: a refusal has it already.
std::string last_dl_error(const std::filesystem::path& library) {
    const char* const text = dlerror();
    std::string message = text != nullptr ? text : "unknown reason";
    const std::string name = library.string() + ": ";
    if (message.compare(0, name.size(), name) == 0) message.erase(0, name.size());
    return message;
}

}  // namespace

PluginRecord fitting_record(const std::filesystem::path& library) {
    const PluginRecord record = read_record(library);
    if (const std::string differing = mismatch(record, build_key()); !differing.empty())
        throw Error("was built differently from this petal: " + differing +
                    "; build it again against this petal, with its compiler flags and libraries");
    return record;
}

OpenedPlugin open_plugin(const std::filesystem::path& library, const PluginRecord& record) {
    OpenedPlugin opened;
    opened.plugin.library = std::filesystem::canonical(library);
    opened.plugin.name = record.name;
    opened.plugin.version = record.version;
    // NODELETE and no dlclose: MRPT's class registry keeps raw pointers into every library it met.
    void* const handle =
        dlopen(opened.plugin.library.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (handle == nullptr) throw Error("cannot be opened: " + last_dl_error(opened.plugin.library));
    using Register = void (*)(Registrar&);
    const auto register_stages = reinterpret_cast<Register>(dlsym(handle, "petal_plugin_register"));
    if (register_stages == nullptr)
        throw Error("has a plugin record but no function petal_plugin_register: " +
                    last_dl_error(opened.plugin.library));
    Collector collector(opened);
    try {
        register_stages(collector);
    } catch (const std::exception& error) {
        throw Error(std::string("failed while it registered its stages: ") + error.what());
    } catch (...) {
        throw Error("failed while it registered its stages: it threw what is no std::exception");
    }
    opened.plugin.types = collector.registry().types();
    for (const StageSpec* spec : collector.registry().all()) opened.stages.push_back(*spec);
    return opened;
}

}  // namespace petal

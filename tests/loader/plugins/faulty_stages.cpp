// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

// Loads well; its stages break their contract when they are made or fire, as their parameters say.
#include <stdexcept>
#include <string>

#include "toy.hpp"

namespace {

struct Doll {};

}  // namespace

template <>
struct petal::PacketTraits<Doll> {
    static constexpr const char* name = "Doll";
    static void seal(Doll&) {}
    static std::size_t bytes(const Doll&) { return 0; }
};

namespace {

/// Emits two frames, "first" and "second".
class Frames final : public petal::Stage {
   public:
    using Params = toys::ToyParams;
    static void describe(petal::Spec<Params>& s) {
        s.summary("Emits two toys.");
        s.writes<toys::Toy>("toy", "a toy");
    }
    explicit Frames(Params) {}
    void run(petal::Run& run) override {
        if (emitted_ == 2) return run.end_of_data();
        run.set_frame(emitted_++ == 0 ? "first" : "second", 0.0);
        run.write("toy", toys::Toy{});
    }

   private:
    int emitted_ = 0;
};

struct ThrowsParams {
    std::string where = "run";
    std::string what = "std";
};

/// Throws at the place and the thing that its parameters say; in run() at the second frame.
class Throws final : public petal::Stage {
   public:
    using Params = ThrowsParams;
    static void describe(petal::Spec<Params>& s) {
        s.summary("Throws.");
        s.reads<toys::Toy>("toy", "a toy");
        s.param("where", &Params::where)
            .choices({"check", "constructor", "run", "finish"})
            .doc("place");
        s.param("what", &Params::what).choices({"std", "petal", "int"}).doc("thing");
        s.check([](const Params& p) {
            if (p.where == "check") throw_one(p);
            return std::string();
        });
    }
    explicit Throws(const Params& p) : p_(p) {
        if (p_.where == "constructor") throw_one(p_);
    }
    void run(petal::Run& run) override {
        if (p_.where == "run" && run.frame().number == 1) throw_one(p_);
    }
    void finish(petal::Run&) override {
        if (p_.where == "finish") throw_one(p_);
    }

   private:
    static void throw_one(const Params& p) {
        if (p.what == "std") throw std::logic_error("the spring is broken");
        if (p.what == "petal") throw petal::Error("the battery is empty");
        throw 42;
    }
    Params p_;
};

struct WritesParams {
    std::string fault = "nothing";
};

/// Writes what it did not promise.
class Writes final : public petal::Stage {
   public:
    using Params = WritesParams;
    static void describe(petal::Spec<Params>& s) {
        s.summary("Writes wrongly.");
        s.reads<toys::Toy>("toy", "a toy");
        s.writes<toys::Toy>("copy", "its copy");
        s.param("fault", &Params::fault)
            .choices({"nothing", "wrong_type", "twice", "undeclared", "in_finish", "reads_other",
                      "reads_undeclared", "ends_data"})
            .doc("what it does wrong");
    }
    explicit Writes(const Params& p) : fault_(p.fault) {}
    void run(petal::Run& run) override {
        if (fault_ == "nothing") return;
        if (fault_ == "wrong_type") return run.write("copy", Doll{});
        if (fault_ == "reads_other") run.in<Doll>("toy");
        if (fault_ == "reads_undeclared") run.in<toys::Toy>("game");
        if (fault_ == "ends_data") run.end_of_data();
        run.write("copy", toys::Toy{});
        if (fault_ == "twice") run.write("copy", toys::Toy{});
        if (fault_ == "undeclared") run.write("shadow", toys::Toy{});
    }
    void finish(petal::Run& run) override {
        if (fault_ == "in_finish") run.write("copy", toys::Toy{});
    }

   private:
    std::string fault_;
};

/// A source that writes and ends its data in one call.
class WritesAtTheEnd final : public petal::Stage {
   public:
    using Params = toys::ToyParams;
    static void describe(petal::Spec<Params>& s) {
        s.summary("Writes in the call that ends its data.");
        s.writes<toys::Toy>("toy", "a toy");
    }
    explicit WritesAtTheEnd(Params) {}
    void run(petal::Run& run) override {
        run.write("toy", toys::Toy{});
        run.end_of_data();
    }
};

}  // namespace

PETAL_PLUGIN("faulty_stages", "1.0.0", [](petal::Registrar& r) {
    r.add<Frames>("faulty.frames");
    r.add<Throws>("faulty.throws");
    r.add<Writes>("faulty.writes");
    r.add<WritesAtTheEnd>("faulty.writes_at_the_end");
});

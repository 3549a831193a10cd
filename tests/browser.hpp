// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

namespace petal::testing {

/// A headless Chromium that a test steers by the DevTools protocol, over a pipe: no port, no other
/// program between. It draws WebGL in software. What pages tell of errors is kept.
class Browser {
   public:
    /// The path of the browser; empty where there is none.
    static std::string program() {
        for (const char* const path : {"/usr/bin/chromium", "/usr/bin/chromium-browser"})
            if (::access(path, X_OK) == 0) return path;
        return {};
    }

    /// \throws std::runtime_error when it does not answer.
    explicit Browser(const std::vector<std::string>& options = {}) {
        std::string folder =
            (std::filesystem::temp_directory_path() / "petal-browser-XXXXXX").string();
        if (::mkdtemp(folder.data()) == nullptr) throw std::runtime_error("no temporary folder");
        profile_ = folder;
        start(options);
        const auto page = call("Target.createTarget", {{"url", "about:blank"}}).at("targetId");
        session_ =
            call("Target.attachToTarget", {{"targetId", page}, {"flatten", true}}).at("sessionId");
        for (const char* const domain : {"Page.enable", "Runtime.enable", "Log.enable"})
            call(domain);
    }
    Browser(const Browser&) = delete;
    Browser& operator=(const Browser&) = delete;
    ~Browser() {
        ::kill(-child_, SIGKILL);
        ::waitpid(child_, nullptr, 0);
        ::close(to_);
        ::close(from_);
        std::error_code ignored;
        // Its helpers may be at work for a moment after it.
        for (int i = 0; i < 20 && std::filesystem::exists(profile_, ignored); ++i) {
            std::filesystem::remove_all(profile_, ignored);
            if (ignored) std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
    }

    /// A command of the protocol. \throws std::runtime_error with its error, or after a minute.
    nlohmann::json call(const std::string& method,
                        const nlohmann::json& params = nlohmann::json::object()) {
        nlohmann::json message{{"id", ++last_id_}, {"method", method}, {"params", params}};
        if (!session_.empty()) message["sessionId"] = session_;
        const std::string text = message.dump();
        write_all(text.c_str(), text.size() + 1);  // each message ends with a zero
        for (;;) {
            nlohmann::json answer = read_message();
            if (answer.value("id", 0) == last_id_) {
                if (answer.contains("error"))
                    throw std::runtime_error(method + ": " + answer["error"].dump());
                return answer.value("result", nlohmann::json::object());
            }
            note_error(answer);
        }
    }

    /// The value of an expression in the page.
    nlohmann::json evaluate(const std::string& expression) {
        const auto answer =
            call("Runtime.evaluate",
                 {{"expression", expression}, {"returnByValue", true}, {"awaitPromise", true}});
        if (answer.contains("exceptionDetails"))
            throw std::runtime_error(answer["exceptionDetails"].dump());
        return answer.at("result").value("value", nlohmann::json());
    }

    /// Waits until the expression is true. Tells whether it came so within half a minute.
    bool becomes_true(const std::string& expression) {
        for (int i = 0; i < 300; ++i) {
            if (evaluate("Boolean(" + expression + ")") == true) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        }
        return false;
    }

    void open(const std::filesystem::path& file) {
        call("Page.navigate", {{"url", "file://" + file.string()}});
        if (!becomes_true("location.protocol === 'file:' && document.readyState === 'complete'"))
            throw std::runtime_error(file.string() + " does not load");
    }

    /// A key as the user presses it: "Tab", "ArrowLeft", "c". `modifiers`: 8 is Shift.
    void press(const std::string& key, int modifiers = 0) {
        nlohmann::json event{{"type", "keyDown"}, {"key", key}, {"modifiers", modifiers}};
        if (key.size() == 1) event["text"] = key;
        if (key == "Tab") event["windowsVirtualKeyCode"] = 9;
        if (key == "Enter") {
            event["windowsVirtualKeyCode"] = 13;
            event["text"] = "\r";
        }
        call("Input.dispatchKeyEvent", event);
        event["type"] = "keyUp";
        event.erase("text");
        call("Input.dispatchKeyEvent", event);
    }

    /// Errors, warnings and messages on the console, exceptions, and requests that were refused.
    const std::vector<std::string>& complaints() const { return complaints_; }

   private:
    void start(const std::vector<std::string>& options) {
        std::array<int, 2> down{};
        std::array<int, 2> up{};
        if (::pipe2(down.data(), O_CLOEXEC) != 0 || ::pipe2(up.data(), O_CLOEXEC) != 0)
            throw std::runtime_error("no pipe");
        std::vector<std::string> words{program(),
                                       "--headless=new",
                                       "--no-sandbox",
                                       "--use-angle=swiftshader",
                                       "--enable-unsafe-swiftshader",
                                       "--remote-debugging-pipe",
                                       "--no-first-run",
                                       "--disable-extensions",
                                       "--disable-dev-shm-usage",
                                       "--window-size=1000,900",
                                       "--user-data-dir=" + profile_.string()};
        words.insert(words.end(), options.begin(), options.end());
        words.emplace_back("about:blank");
        std::vector<char*> arguments;
        for (std::string& word : words) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        child_ = ::fork();
        if (child_ == 0) {
            ::setpgid(0, 0);
            // It reads from 3 and writes to 4. First out of the way, since the pipes may be 3
            // and 4.
            const int in = ::fcntl(down[0], F_DUPFD, 10);
            const int out = ::fcntl(up[1], F_DUPFD, 10);
            const int nothing = ::open("/dev/null", O_RDWR);
            for (const int stream : {0, 1, 2}) ::dup2(nothing, stream);
            ::dup2(in, 3);
            ::dup2(out, 4);
            ::execv(arguments[0], arguments.data());
            ::_exit(127);
        }
        ::close(down[0]);
        ::close(up[1]);
        to_ = down[1];
        from_ = up[0];
        if (child_ < 0) throw std::runtime_error("no process");
        ::signal(SIGPIPE, SIG_IGN);
    }

    void write_all(const char* bytes, std::size_t size) const {
        while (size > 0) {
            const ssize_t written = ::write(to_, bytes, size);
            if (written <= 0) throw std::runtime_error("the browser has gone");
            bytes += written;
            size -= static_cast<std::size_t>(written);
        }
    }

    nlohmann::json read_message() {
        for (;;) {
            const std::size_t end = buffer_.find('\0');
            if (end != std::string::npos) {
                auto message = nlohmann::json::parse(buffer_.substr(0, end));
                buffer_.erase(0, end + 1);
                return message;
            }
            pollfd waiting{from_, POLLIN, 0};
            constexpr int kLongest = 60000;  // ms: on a busy machine it may start slowly
            if (::poll(&waiting, 1, kLongest) <= 0)
                throw std::runtime_error("the browser does not answer");
            std::array<char, 65536> piece{};
            const ssize_t got = ::read(from_, piece.data(), piece.size());
            if (got <= 0) throw std::runtime_error("the browser has gone");
            buffer_.append(piece.data(), static_cast<std::size_t>(got));
        }
    }

    void note_error(const nlohmann::json& event) {
        const std::string method = event.value("method", "");
        if (method == "Runtime.exceptionThrown" || method == "Runtime.consoleAPICalled" ||
            method == "Log.entryAdded" || method == "Page.javascriptDialogOpening")
            complaints_.push_back(event.at("params").dump());
    }

    std::filesystem::path profile_;
    pid_t child_ = -1;
    int to_ = -1;
    int from_ = -1;
    int last_id_ = 0;
    std::string session_;
    std::string buffer_;
    std::vector<std::string> complaints_;
};

}  // namespace petal::testing

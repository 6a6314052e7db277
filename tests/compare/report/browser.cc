// SPDX-License-Identifier: LGPL-2.1-or-later
#include "browser.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): kill() is POSIX
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <stdexcept>

namespace ciliaval::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error("chromium: " + what);
}

/// A pipe whose ends are neither 3 nor 4, where the browser expects its own.
std::array<int, 2> make_pipe() {
  std::array<int, 2> low{};
  if (pipe2(low.data(), O_CLOEXEC) != 0) fail("no pipe");
  const std::array<int, 2> ends{fcntl(low[0], F_DUPFD_CLOEXEC, 10),
                                fcntl(low[1], F_DUPFD_CLOEXEC, 10)};
  close(low[0]);
  close(low[1]);
  return ends;
}

pid_t spawn(const std::vector<std::string>& words, int in, int out) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, in, 3);
  posix_spawn_file_actions_adddup2(&files, out, 4);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  std::vector<std::string> copies = words;
  std::vector<char*> arguments;
  arguments.reserve(copies.size() + 1);
  for (std::string& word : copies) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t process = -1;
  const int error =
      posix_spawnp(&process, arguments[0], &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) fail("it does not start");
  return process;
}

}  // namespace

bool Browser::is_installed() {
  return std::system("command -v chromium >/dev/null 2>&1") == 0;
}

Browser::Browser() {
  std::string name = (fs::temp_directory_path() / "ciliaval-browser-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) fail("no folder for its profile");
  profile_ = name;
  std::vector<std::string> words{"chromium",
                                 "--headless=new",
                                 "--disable-gpu",
                                 "--disable-dev-shm-usage",
                                 "--no-first-run",
                                 "--disable-background-networking",
                                 "--remote-debugging-pipe",
                                 "--user-data-dir=" + name};
  if (geteuid() == 0) words.emplace_back("--no-sandbox");  // its sandbox does not work for root
  const std::array<int, 2> commands = make_pipe();
  const std::array<int, 2> answers = make_pipe();
  process_ = spawn(words, commands[0], answers[1]);
  close(commands[0]);
  close(answers[1]);
  to_ = commands[1];
  from_ = answers[0];
  const json target = call("Target.createTarget", {{"url", "about:blank"}});
  session_ = call("Target.attachToTarget", {{"targetId", target.at("targetId")}, {"flatten", true}})
                 .at("sessionId");
  for (const char* domain : {"Page", "Runtime", "Log", "Network"})
    call(std::string(domain) + ".enable", json::object());
}

Browser::~Browser() {
  close(to_);
  close(from_);
  kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
  std::error_code ignored;
  for (int i = 0; i < 20 && fs::exists(profile_); ++i) {  // its children may still be writing
    fs::remove_all(profile_, ignored);
    if (fs::exists(profile_)) usleep(100000);
  }
}

json Browser::receive() {
  std::size_t end = received_.find('\0');
  while (end == std::string::npos) {
    pollfd ready{from_, POLLIN, 0};
    constexpr int patience = 120000;  // ms; a stopped machine must not fail a test
    if (poll(&ready, 1, patience) <= 0) fail("it does not answer");
    std::array<char, 65536> part{};
    const ssize_t n = read(from_, part.data(), part.size());
    if (n <= 0) fail("it has ended");
    received_.append(part.data(), static_cast<std::size_t>(n));
    end = received_.find('\0');
  }
  json message = json::parse(received_.substr(0, end));
  received_.erase(0, end + 1);
  return message;
}

void Browser::note(const json& event) {
  const std::string method = event.value("method", "");
  if (method == "Page.loadEventFired") loaded_ = true;
  if (method == "Runtime.consoleAPICalled") {
    const std::string type = event["params"]["type"];
    if (type == "error" || type == "warning" || type == "assert")
      record_.messages.push_back(type + ": " + event["params"]["args"].dump());
  }
  if (method == "Runtime.exceptionThrown")
    record_.messages.push_back(event["params"]["exceptionDetails"].dump());
  if (method == "Log.entryAdded") {
    const std::string level = event["params"]["entry"]["level"];
    if (level == "error" || level == "warning")
      record_.messages.push_back(event["params"]["entry"]["text"]);
  }
  if (method == "Network.requestWillBeSent") {
    const std::string url = event["params"]["request"]["url"];
    if (url != page_ && !url.starts_with("data:")) record_.requests.push_back(url);
  }
}

json Browser::call(const std::string& method, const json& parameters) {
  json message{{"id", ++last_id_}, {"method", method}, {"params", parameters}};
  if (!session_.empty()) message["sessionId"] = session_;
  const std::string text = message.dump();
  if (write(to_, text.c_str(), text.size() + 1) != static_cast<ssize_t>(text.size() + 1))
    fail("it does not listen");
  while (true) {
    const json answer = receive();
    note(answer);
    if (answer.value("id", 0) != last_id_) continue;
    if (answer.contains("error")) fail(method + ": " + answer["error"].dump());
    return answer["result"];
  }
}

PageRecord Browser::open(const fs::path& file, int width) {
  constexpr int widest_phone = 600;
  call("Emulation.setDeviceMetricsOverride", {{"width", width},
                                              {"height", 800},
                                              {"deviceScaleFactor", 1},
                                              {"mobile", width <= widest_phone}});
  page_ = "file://" + file.string();
  record_ = {};
  loaded_ = false;
  call("Page.navigate", {{"url", page_}});
  while (!loaded_) note(receive());
  // Two frames later it is laid out and has said what it has to say.
  evaluate("new Promise(r => requestAnimationFrame(() => requestAnimationFrame(() => r(1))))");
  return record_;
}

json Browser::evaluate(const std::string& expression) {
  const json result =
      call("Runtime.evaluate",
           {{"expression", expression}, {"returnByValue", true}, {"awaitPromise", true}});
  if (result.contains("exceptionDetails")) fail(result["exceptionDetails"].dump());
  return result["result"].contains("value") ? result["result"]["value"] : json();
}

void Browser::press(const std::string& key, int code) {
  json event{{"type", "keyDown"}, {"key", key}, {"code", key}, {"windowsVirtualKeyCode", code}};
  if (key == "Enter") event["text"] = "\r";
  call("Input.dispatchKeyEvent", event);
  event["type"] = "keyUp";
  event.erase("text");
  call("Input.dispatchKeyEvent", event);
}

}  // namespace ciliaval::test

#include "process.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>
#include <new>
#include <system_error>

#include "lumirank/lumirank.h"

namespace lumirank::cli {

std::atomic<bool> g_interrupted{false};

namespace {

void on_signal(int) {
  if (!g_interrupted.exchange(true)) return;
  remove_temporary_files();
  _exit(130);
}

void say(const char* text) {
  if (write(STDERR_FILENO, text, std::strlen(text)) < 0) return;  // nothing more can be done
}

// An exception that nothing could catch, as when there is no memory to throw it or to start a thread.
[[noreturn]] void on_terminate() {
  remove_temporary_files();
  const char* no_memory =
      "lumirank: there is not enough memory; ask for fewer --lights, a smaller --size or a lower --spp\n";
  try {
    if (const auto error = std::current_exception()) std::rethrow_exception(error);
    say("lumirank: internal error: ended without an exception\n");
  } catch (const std::bad_alloc&) {
    say(no_memory);
    _exit(2);
  } catch (const std::exception& error) {
    const auto* system = dynamic_cast<const std::system_error*>(&error);
    if (system && system->code() == std::errc::resource_unavailable_try_again) {  // no thread can be started
      say(no_memory);
      _exit(2);
    }
    say("lumirank: internal error: ");
    say(error.what());
    say("\n");
  } catch (...) {
    say("lumirank: internal error: an exception of unknown kind\n");
  }
  _exit(1);
}

// A stream that the caller has closed would be the next file that is opened: an image with messages in it.
void hold_standard_streams() {
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(fd, F_GETFD) == -1 && errno == EBADF)
      // Not to be written, so that it is found out that output is lost.
      if (open("/dev/null", fd == STDERR_FILENO ? O_WRONLY : O_RDONLY) < 0) _exit(1);
}

}  // namespace

void prepare_process() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
  // `nohup` has it ignored, and it stays so.
  struct sigaction inherited {};
  if (sigaction(SIGHUP, nullptr, &inherited) == 0 && inherited.sa_handler != SIG_IGN)
    sigaction(SIGHUP, &action, nullptr);
  // Writes then fail, with a reason and a way out that leaves no temporary file.
  action.sa_handler = SIG_IGN;
  for (const int signal : {SIGXFSZ, SIGPIPE}) sigaction(signal, &action, nullptr);
  std::set_terminate(on_terminate);
  hold_standard_streams();
}

void end_by_broken_pipe() {
  remove_temporary_files();
  struct sigaction action {};
  action.sa_handler = SIG_DFL;
  sigaction(SIGPIPE, &action, nullptr);
  raise(SIGPIPE);
  _exit(2);
}

}  // namespace lumirank::cli

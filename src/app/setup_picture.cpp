#include "app/setup_picture.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "app/python_program.hpp"
#include "base/error.hpp"

namespace thawslide::app {

namespace {

// Unnamed temporary file, which no other process can open and which is deleted with its last reader.
class NamelessFile {
 public:
  explicit NamelessFile(const std::string& text) : file_(std::tmpfile(), &std::fclose) {
    const bool is_written = file_ != nullptr && std::fwrite(text.data(), 1, text.size(), file_.get()) == text.size() &&
                            std::fflush(file_.get()) == 0;
    if (!is_written) {
      throw UserError("the picture was not drawn: a temporary file cannot be written: {}.", std::strerror(errno));
    }
  }
  // Makes the file this process's standard input, read from its beginning.
  [[nodiscard]] bool becomes_input() const {
    const int descriptor = fileno(file_.get());
    return lseek(descriptor, 0, SEEK_SET) == 0 && dup2(descriptor, STDIN_FILENO) == STDIN_FILENO;
  }

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

}  // namespace

std::string picture_path(const std::filesystem::path& case_file) {
  const std::string variant = case_file.stem() == "case" ? "" : case_file.stem().string() + "-";
  return (case_file.parent_path() / (variant + "setup.png")).string();
}

void draw_setup(const nlohmann::ordered_json& setup, const std::string& picture) {
  const NamelessFile file(setup.dump());
  const std::string program = python_program("thawslide-report");
  std::fflush(stdout);  // so that earlier output precedes the child's
  const pid_t child = fork();
  if (child == 0) {
    // Output of the child goes to stderr, because a program may read our stdout.
    if (file.becomes_input() && dup2(STDERR_FILENO, STDOUT_FILENO) == STDOUT_FILENO) {
      execlp(program.c_str(), program.c_str(), "--setup", "/dev/stdin", "--picture", picture.c_str(), nullptr);
    }
    _exit(127);
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    const bool is_found = !WIFEXITED(status) || WEXITSTATUS(status) != 127;
    throw UserError("the picture was not drawn: thawslide-report {}. {}", is_found ? "failed" : "is not on PATH",
                    python_program_remedy);
  }
}

}  // namespace thawslide::app

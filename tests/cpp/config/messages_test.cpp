// Messages of cases, in the tables messages/*.txt. A table has a section for each test:
//
//   = Suite.Test         what follows is of this test
//   # reason             of the next trial, printed if it fails
//   on dem, on section   the base case: valid_case_on_dem, or valid_case (the default)
//   file NAME: TEXT      writes a file next to the case file
//   FROM => TO           changes the base case for one trial; also: add TEXT (at the end), without TEXT,
//                        before FROM: TEXT, after FROM: TEXT; " | " parts lines as in one_key_per_line
//   with CHANGE          changes the base case for all trials that follow
//   --set KEY=VALUE      of one trial; several may stand in a line
//   > TEXT               ends the trial: a line of the complete error ("no error": none), without "FOLDER/case.toml:"
//   ~ TEXT               ends the trial: a part of the error
//   ! TEXT               ends the trial: a warning of the valid case, of all it has ("no warning": none)
//   >> --set KEY=VALUE: TEXT, and !!    a whole trial: the error or warning that this value causes
//   no error: LINE, no warning: LINE    ends the trial with a change or values
#include <algorithm>
#include <map>

#include "case_messages.hpp"
#include "config/notices.hpp"

namespace thawslide::config {
namespace {

namespace fs = std::filesystem;
using namespace case_messages;

// The text after `start`, if the line begins with it.
bool begins(const std::string& line, const std::string& start, std::string& rest) {
  if (line.rfind(start, 0) != 0) {
    return false;
  }
  rest = line.substr(start.size());
  return true;
}

std::pair<std::string, std::string> split_at(const std::string& text, const std::string& mark) {
  const std::size_t at = text.find(mark);
  if (at == std::string::npos) {
    throw std::logic_error("no" + mark + "in " + text);
  }
  return {one_key_per_line(text.substr(0, at)), one_key_per_line(text.substr(at + mark.size()))};
}

std::string with_change(const std::string& text, const std::string& line) {
  std::string rest;
  if (begins(line, "add ", rest)) {
    return text + one_key_per_line(rest) + "\n";
  }
  if (begins(line, "without ", rest)) {
    return changed({{one_key_per_line(rest) + "\n", ""}}, text);
  }
  if (begins(line, "before ", rest)) {
    const auto [place, lines] = split_at(rest, ": ");
    return changed({{place, lines + "\n" + place}}, text);
  }
  if (begins(line, "after ", rest)) {
    const auto [place, lines] = split_at(rest, ": ");
    return changed({{place, place + "\n" + lines}}, text);
  }
  return changed({split_at(line, " => ")}, text);
}

struct Line {
  int number;
  std::string text;
};

class CaseMessages : public testing::Test {
 public:
  CaseMessages(std::string file, std::vector<Line> lines) : file_(std::move(file)), lines_(std::move(lines)) {}

  void TestBody() override {
    write_map_files();
    std::string rest;
    for (const auto& [number, line] : lines_) {
      const bool is_expected = begins(line, "> ", rest) || begins(line, "~ ", rest) || begins(line, "! ", rest);
      if (!is_expected && !expected_.empty()) {
        compare();
      }
      number_ = number;
      if (is_expected) {
        expected_[line.front()].push_back(rest);
      } else if (begins(line, ">> --set ", rest) || begins(line, "!! --set ", rest)) {
        change("--set " + rest.substr(0, rest.find(": ")));
        expected_[line.front()] = {"--set " + rest};
      } else if (begins(line, "no error: ", rest)) {
        change(rest);
        expected_['>'] = {"no error"};
      } else if (begins(line, "no warning: ", rest)) {
        change(rest);
        expected_['!'] = {"no warning"};
      } else if (begins(line, "# ", rest)) {
        reason_ = rest;
      } else if (begins(line, "on ", rest)) {
        base_ = text_ = rest == "dem" ? valid_case_on_dem : valid_case;
      } else if (begins(line, "file ", rest)) {
        const auto [name, text] = split_at(rest, ": ");
        write_next_to_the_case(name, text + "\n");
      } else if (begins(line, "with ", rest)) {
        base_ = text_ = with_change(base_, rest);
      } else {
        change(line);
      }
    }
    compare();
  }

 private:
  void change(const std::string& line) {
    std::string sets;
    if (!begins(line, "--set ", sets)) {
      text_ = with_change(text_, line);
      return;
    }
    sets = replaced(sets, "FOLDER", folder_of_this_test().string());
    for (std::size_t end = 0; end != std::string::npos; sets.erase(0, end + 7)) {
      end = sets.find(" --set ");
      sets_.push_back(sets.substr(0, end));
    }
  }

  static std::string at_its_place(const std::string& message) {
    const bool has_place = message.front() >= '0' && message.front() <= '9';
    return (has_place ? "FOLDER/case.toml:" : "") + message;
  }

  void compare() {
    SCOPED_TRACE(fmt::format("{}:{}: {}", file_, number_, reason_));
    EXPECT_FALSE(expected_.empty()) << "nothing is expected";
    const std::string found = error_of_text(text_, sets_);
    std::string complete;
    for (const std::string& message : expected_['>']) {
      complete += (complete.empty() ? "" : "\n") + at_its_place(message);
    }
    EXPECT_TRUE(complete.empty() || found == complete) << found << "\nis not\n" << complete;
    for (const std::string& part : expected_['~']) {
      EXPECT_NE(found.find(part), std::string::npos) << found << "\ndoes not contain\n" << part;
    }
    if (std::vector<std::string> warnings = expected_['!']; !warnings.empty()) {
      std::transform(warnings.begin(), warnings.end(), warnings.begin(), at_its_place);
      std::vector<std::string> all = notices(testing_support::case_from_text(text_, sets_));
      std::transform(all.begin(), all.end(), all.begin(), without_folder);
      EXPECT_EQ(all, warnings.front() == "no warning" ? std::vector<std::string>() : warnings);
    }
    text_ = base_;
    sets_.clear();
    expected_.clear();
    reason_.clear();
  }

  std::string file_, base_ = valid_case, text_ = valid_case, reason_;
  std::vector<Line> lines_;
  int number_ = 0;
  std::vector<std::string> sets_;
  std::map<char, std::vector<std::string>> expected_;
};

// Registers a test for each section of each file.
const bool are_registered = [] {
  for (const auto& entry : fs::directory_iterator(fs::path(THAWSLIDE_SOURCE_DIR) / "tests/cpp/config/messages")) {
    if (entry.path().extension() != ".txt") {
      continue;
    }
    const std::string file = entry.path().string();
    std::ifstream stream(file);
    std::string suite, name;
    std::vector<Line> lines;
    int number = 0, first = 0;
    const auto finish = [&] {
      if (!lines.empty()) {
        testing::RegisterTest(suite.c_str(), name.c_str(), nullptr, nullptr, file.c_str(), first,
                              [=]() -> testing::Test* { return new CaseMessages(file, lines); });
      }
      lines.clear();
    };
    for (std::string line; std::getline(stream, line);) {
      ++number;
      if (std::string title; begins(line, "= ", title)) {
        finish();
        suite = title.substr(0, title.find('.'));
        name = title.substr(title.find('.') + 1);
        first = number;
      } else if (!line.empty() && first > 0) {
        lines.push_back({number, line});
      }
    }
    finish();
  }
  return true;
}();

}  // namespace
}  // namespace thawslide::config

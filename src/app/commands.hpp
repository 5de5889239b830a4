// Commands of the program. Each returns an exit code (ExitCode), or throws UserError.
#pragma once

#include <string>
#include <vector>

#include "config/case_proposal.hpp"

namespace thawslide::app {

struct CaseOptions {
  std::string file;
  std::vector<std::string> sets;
};

struct RunOptions {
  CaseOptions of_case;
  int threads = 0;  // 0: all available cores
  std::string device = "cpu";
  std::string output;
  bool overwrite = false;
  std::string end;    // time.end [s]; empty: that of the case
  bool pair = false;  // on cells of twice and four times the size as well
};
int run_case(const RunOptions& options);

struct ResumeOptions {
  std::string folder;
  int threads = 0;
  std::string device = "cpu";
  std::vector<std::string> sets;  // changes to the case
  std::string end;                // new time.end [s]; empty: unchanged
};
int resume_run(const ResumeOptions& options);

int print_status(const std::string& folder, bool json);

struct CheckOptions {
  CaseOptions of_case;
  int threads = 0;
  bool draws = false;   // plot a figure
  std::string picture;  // its file; empty: setup.png in the folder of the case
  bool json = false;    // output for programs
};
int check_case(const CheckOptions& options);

int run_block_model(const CaseOptions& of_case, const std::string& output);

// Input files of a new case.
struct MapOptions {
  std::string dem, release, crs;  // crs: for a DEM file without one
  double thickness = 0.0;         // m, vertical; 0: the attribute "thickness"
  bool cut = false;               // excavate the DEM instead of adding to it
  double largest_volume = 0.0;    // m3, confirmed; 0: default of the parameter
};

struct NewOptions {
  std::string program;  // as called by the user
  std::string folder;
  MapOptions maps;
  double reach_angle = config::usual_reach_angle;  // degrees
  double cell = 0.0;                               // m; 0: from the resolution
  std::string resolution;                          // a name of config::resolutions; empty: quick
  config::Outlines outlines;  // files of polygons by the names of config::proposed_substrates; empty: none
};
int make_new_case(const NewOptions& options);

struct SectionOptions {
  std::string program;
  std::string folder;
  MapOptions maps;  // release: empty for the profile alone
  std::string line;
};
int make_section(const SectionOptions& options);

struct DescribeOptions {
  bool json = false, markdown = false, schema = false, outputs = false;
};
int describe_parameters(const DescribeOptions& options);

// Replaces the process by `thawslide-NAME` of the Python package; returns only if it is not found.
int run_python_command(const std::string& name, const std::vector<std::string>& arguments);

// Version, commit and compiler.
std::string version_text();
int print_version();

}  // namespace thawslide::app

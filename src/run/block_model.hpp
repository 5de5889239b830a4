// Block model of a case: a rigid block on its profile, or on the section along its path.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"
#include "config/case_proposal.hpp"
#include "run/observer.hpp"
#include "sim/records/history.hpp"

namespace thawslide::run {

// Value of a column of a row.
[[nodiscard]] double value_of(const sim::HistoryRow& row, const std::string& name);

// Rows of the block's motion to the end of the run or of the known terrain. Reports warnings. Throws UserError.
[[nodiscard]] std::vector<sim::HistoryRow> block_rows(const config::Case& parameters, Observer& observer);

// Base [basal] of a new case: the thinnest band that config::ProposedBase allows, without substrates. Throws UserError.
[[nodiscard]] config::ProposedBase propose_base(config::Case parameters);

}  // namespace thawslide::run

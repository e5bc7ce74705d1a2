// Prices of secondary rays as tables, plots and sections of the page.
// Memory: the book's. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "experiment/book.h"
#include "experiment/secondary_prices.h"

namespace gridiron::experiment {

/// Writes the sections. The sentences follow from the prices.
void write_secondary_prices(const SecondaryPrices& prices, Book& book);

/// @returns the names of all files that it writes.
[[nodiscard]] std::vector<std::string> secondary_file_names();

}  // namespace gridiron::experiment

// Price book: the price list as tables, plots and a page.
// Memory: the book's. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "experiment/book.h"
#include "experiment/price_list.h"
#include "experiment/table.h"

namespace gridiron::experiment {

/// @returns the costs of a view's frames and their errors, a row for each configuration and profile.
[[nodiscard]] Table view_costs(const PriceList& list, std::size_t view);
/// @param split_leaks  whether holes and rays that see through have columns of their own.
[[nodiscard]] Table view_errors(const PriceList& list, std::size_t view, bool split_leaks);

/// Each function writes one or more sections. The sentences follow from the list.
void write_overview(const PriceList& list, Book& book);
void write_targets(const PriceList& list, Book& book);
void write_steps(const PriceList& list, Book& book);
void write_fronts(const PriceList& list, Book& book);
void write_starved(const PriceList& list, Book& book);
void write_views(const PriceList& list, Book& book);

/// Times of this host: one frame after another on one thread, without other work of ours. Errors: Failure.
void write_host_prices(const PriceList& list, Book& book);

/// @returns the name of the file with a view's prices as plain text.
[[nodiscard]] std::string price_text_name(const std::string& view_key);

}  // namespace gridiron::experiment

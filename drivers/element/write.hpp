// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "element_test.hpp"
#include "results.hpp"
#include "run.hpp"

namespace grainlaw::element {

/// A run's CSV while it is being computed: rows reach the disk at least once a second.
class CsvWriter {
 public:
  CsvWriter(const std::filesystem::path& path, const ElementFile& file, const ElementTest& test);
  ~CsvWriter();
  CsvWriter(const CsvWriter&) = delete;
  CsvWriter& operator=(const CsvWriter&) = delete;
  void row(const std::vector<Column>& columns, const double* values);
  void close(const std::vector<Column>& columns);

 private:
  void header(const std::vector<Column>& columns);
  void flush();
  std::FILE* out;
  std::filesystem::path path;
  std::string head, buffer;
  bool header_written = false;
  double last_flush = 0;
};

/// Everything a run of one file produced.
struct FileOutcome {
  std::vector<RunRecord> records;
  std::vector<ExpectationResult> expectations;
  std::vector<ComparisonResult> comparisons;
  std::vector<ResultRow> table;
  int exit_code = 0;
  double wall_s = 0, cpu_s = 0;
};

/// Writes as_run.yaml, measured/*.csv and summary.json of one file into dir.
void write_results(const std::filesystem::path& dir, const ElementFile& file, const FileOutcome& outcome);

/// Writes the summary of several files.
void write_combined(const std::filesystem::path& dir, const std::vector<ElementFile>& files,
                    const std::vector<std::filesystem::path>& folders, const std::vector<FileOutcome>& outcomes,
                    int exit_code);

double peak_memory_mb();

}  // namespace grainlaw::element

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "compare/output/provenance.h"
#include "problem/load.h"

class vtkDataSet;

namespace ciliaval::compare::output::vtk {

/// `.vtu`, `.vtp` or `.vti` without the dot: the XML format of this kind of data set.
std::string extension(const vtkDataSet& data);

/// Adds texts under a name to the field data.
void add_strings(vtkDataSet& data, const char* name, const std::vector<std::string>& values);

/// Adds a number under a name to the field data.
void add_number(vtkDataSet& data, const char* name, double number);

/// Adds where the data come from and the load (N, N/m or m) to the field data: `provenance`,
/// `load`, `load_unit`.
void add_provenance(vtkDataSet& data, const Provenance& provenance, const Load& load);

/// The same of data without a load: `provenance` only.
void add_provenance(vtkDataSet& data, const Provenance& provenance);

/// Writes a data set in the XML format of its kind, appended and compressed. Throws FileError with
/// the path and the reason; VTK's Write() alone does not notice a full disk, its error code does.
void write(vtkDataSet& data, const std::filesystem::path& file);

/// Times of a load path in a series: the load if it increases from step to step, else the number of
/// the step.
std::vector<double> series_times(const LoadPath& path);

/// Writes `series.pvd`, which lists those files `series_0000.ext`, … that exist in the folder.
/// Writes none if there is no such file.
void write_series(const std::filesystem::path& folder, const std::string& series,
                  const std::string& extension, const std::vector<double>& times);

/// The paraview.simple script that opens every series beside it.
extern const char* const open_script;

}  // namespace ciliaval::compare::output::vtk

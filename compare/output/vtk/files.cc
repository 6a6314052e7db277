// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/vtk/files.h"

#include <fmt/core.h>
#include <vtkDataSet.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkObject.h>
#include <vtkStringArray.h>
#include <vtkXMLDataObjectWriter.h>
#include <vtkXMLWriter.h>

#include <algorithm>
#include <functional>
#include <variant>

#include "compare/output/output_file.h"
#include "compare/output/results.h"
#include "compare/output/sweep.h"
#include "problem/description/environment.h"
#include "problem/error.h"

namespace ciliaval::compare::output::vtk {
namespace {

vtkSmartPointer<vtkXMLWriter> writer_for(const vtkDataSet& data) {
  const int type = const_cast<vtkDataSet&>(data).GetDataObjectType();  // not const in VTK
  auto writer = vtkSmartPointer<vtkXMLWriter>::Take(vtkXMLDataObjectWriter::NewWriter(type));
  if (!writer) throw InputError("this kind of VTK data set has no writer here");
  return writer;
}

void add_vector(vtkDataSet& data, const char* name, const Vector3& vector) {
  const vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(3);
  array->InsertNextTuple(vector.data());
  data.GetFieldData()->AddArray(array);
}

}  // namespace

void add_strings(vtkDataSet& data, const char* name, const std::vector<std::string>& values) {
  const vtkNew<vtkStringArray> array;
  array->SetName(name);
  for (const std::string& value : values) array->InsertNextValue(value);
  data.GetFieldData()->AddArray(array);
}

void add_number(vtkDataSet& data, const char* name, double number) {
  const vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->InsertNextValue(number);
  data.GetFieldData()->AddArray(array);
}

std::string extension(const vtkDataSet& data) {
  return writer_for(data)->GetDefaultFileExtension();
}

void add_provenance(vtkDataSet& data, const Provenance& provenance) {
  std::vector<std::string> lines{"CiliaVal " + provenance.version, "git: " + provenance.git,
                                 "command: " + provenance.command, "date: " + provenance.date};
  for (const auto& [library, version] : provenance.libraries)
    lines.push_back(fmt::format("{} {}", library, version));
  add_strings(data, "provenance", lines);
}

void add_provenance(vtkDataSet& data, const Provenance& provenance, const Load& load) {
  add_provenance(data, provenance);
  add_strings(data, "load_unit", {std::string(magnitude_unit(load))});
  add_number(data, "load", magnitude(load));
  const surroundings::Environment& around = load.environment();
  if (surroundings::is_empty(around)) return;
  for (const auto& field : description::fields<surroundings::Environment>()) {
    const std::string name(field.name);
    const description::Value stated = field.get(around);
    if (const auto* vector = std::get_if<Vector3>(&stated))
      add_vector(data, name.c_str(), *vector);
    else if (const auto* text = std::get_if<std::string>(&stated))
      add_strings(data, name.c_str(), {*text});
    else
      add_number(data, name.c_str(), std::get<double>(stated));
  }
}

void write(vtkDataSet& data, const std::filesystem::path& file) {
  vtkObject::GlobalWarningDisplayOff();  // the exception reports
  const auto writer = writer_for(data);
  writer->SetInputData(&data);
  writer->SetFileName(file.c_str());
  writer->SetDataModeToAppended();
  writer->SetCompressorTypeToZLib();
  // The fastest; the files are hardly larger than at the default (docs/measurements.md).
  writer->SetCompressionLevel(1);
  const int written = writer->Write();
  const unsigned long error = writer->GetErrorCode();
  if (written == 1 && error == vtkErrorCode::NoError) return;
  throw FileError("cannot write `" + file.string() +
                  "`: " + vtkErrorCode::GetStringFromErrorCode(error));
}

std::vector<double> series_times(const LoadPath& path) {
  std::vector<double> times;
  if (path.front().is<SweepLoad>()) return ways(path);
  for (const Load& load : path) times.push_back(magnitude(load));
  if (std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) != times.end())
    for (std::size_t i = 0; i < times.size(); ++i) times[i] = static_cast<double>(i);
  return times;
}

void write_series(const std::filesystem::path& folder, const std::string& series,
                  const std::string& extension, const std::vector<double>& times) {
  std::string entries;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const std::string file = step_file(series, i, extension);
    if (std::filesystem::exists(folder / file))
      entries += fmt::format("    <DataSet timestep=\"{}\" file=\"{}\"/>\n", times[i], file);
  }
  if (entries.empty()) return;
  write_file(folder / (series + ".pvd"),
             "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n"
             "  <Collection>\n" +
                 entries + "  </Collection>\n</VTKFile>\n");
}

}  // namespace ciliaval::compare::output::vtk

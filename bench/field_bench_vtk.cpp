#include "field_bench_vtk.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#pragma GCC diagnostic pop

namespace verdure {

std::size_t flyingEdges(const Lattice& lattice, std::vector<float>& sums, float tau) {
  vtkNew<vtkFloatArray> array;
  array->SetArray(sums.data(), static_cast<vtkIdType>(sums.size()), 1);
  vtkNew<vtkImageData> image;
  image->SetDimensions(lattice.points.x, lattice.points.y, lattice.points.z);
  const double h = static_cast<double>(lattice.spacing);
  image->SetSpacing(h, h, h);
  image->GetPointData()->SetScalars(array);
  vtkNew<vtkFlyingEdges3D> filter;
  filter->SetInputData(image);
  filter->SetValue(0, static_cast<double>(tau));
  filter->ComputeNormalsOn();
  filter->ComputeGradientsOff();
  filter->ComputeScalarsOff();
  filter->Update();
  return static_cast<std::size_t>(filter->GetOutput()->GetNumberOfPoints());
}

}  // namespace verdure

#include "meshes/cylinder_mesh.h"

#include "fem/beam/beam.h"

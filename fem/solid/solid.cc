#include "fem/solid/solid.h"

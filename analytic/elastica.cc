#include "analytic/elastica.h"

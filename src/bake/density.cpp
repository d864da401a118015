#include "verdure/density.h"

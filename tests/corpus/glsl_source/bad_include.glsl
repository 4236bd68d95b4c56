#include "a"
/* open
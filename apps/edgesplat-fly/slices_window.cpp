#include "apps/edgesplat-fly/panels.h"

void slices_window(AppState&) {}

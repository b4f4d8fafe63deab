/* What the files of this port share. */
#ifndef PANELDRAW_BOARD_H
#define PANELDRAW_BOARD_H

#include "paneldraw.h"

void pd_panel_init(void);

#endif

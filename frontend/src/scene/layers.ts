/** Layers of three.js. Objects are in layer 0 by default, which cameras render. */

/** Outlined because the object is selected. */
export const SELECTED_LAYER = 1;
/** Highlighted briefly. */
export const FLASHING_LAYER = 2;
/** Tested by rays, but drawn as part of a batch. */
export const PICKABLE_LAYER = 3;

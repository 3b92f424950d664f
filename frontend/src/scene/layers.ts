/** Layers of three.js: what cameras see is in layer 0, as everything is at first. */

/** Outlined because it is selected. */
export const SELECTED = 1;
/** Lights up for a moment. */
export const FLASHING = 2;
/** Met by rays, but drawn by something else together with others. */
export const TOUCHED = 3;

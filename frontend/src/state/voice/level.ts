/** The level at which a meter is empty, dB below full scale. */
const FLOOR_DB = 60;

/** Returns the share of a meter that a peak of 0 to 1 fills, on a scale in dB. */
export function computeMeterShare(peak: number): number {
  return peak <= 0 ? 0 : Math.max(0, Math.min(1, 1 + (20 * Math.log10(peak)) / FLOOR_DB));
}

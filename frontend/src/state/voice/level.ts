/** Decibels below full scale at which a meter is empty. */
const FLOOR = 60;

/** The part of a meter that a peak of 0 to 1 fills, by its decibels. */
export function meterPart(peak: number): number {
  return peak <= 0 ? 0 : Math.max(0, Math.min(1, 1 + (20 * Math.log10(peak)) / FLOOR));
}

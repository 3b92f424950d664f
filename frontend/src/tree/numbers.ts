/** The magnitude from which numbers with fixed decimals are written with an exponent. */
const MIN_EXPONENT_VALUE = 1e6;

/** Returns a number as in a property row: at most six significant digits, no trailing zeros. */
export function formatNumber(value: number): string {
  if (!Number.isFinite(value)) return String(value);
  const text = String(Number(value.toPrecision(6)));
  return text === "-0" ? "0" : text;
}

/** Returns `1; 2; 3` with five digits for the largest number, as in RViz, and as many decimals for the others. */
export function formatPoint(values: readonly number[]): string {
  const maxMagnitude = Math.max(...values.map(Math.abs));
  const digits = maxMagnitude > 0 ? Math.min(Math.max(4 - Math.floor(Math.log10(maxMagnitude)), 0), 12) : 0;
  return values.map((value) => formatNumber(Number(value.toFixed(digits)))).join("; ");
}

/**
 * Returns a number with fixed decimals and without minus zero; a large one, such as a limit that means no limit, has
 * an exponent.
 */
export function formatFixed(value: number, digits: number): string {
  if (Math.abs(value) >= MIN_EXPONENT_VALUE) return value.toExponential(2);
  const text = value.toFixed(digits);
  return Number(text) === 0 ? (0).toFixed(digits) : text;
}

/** Parses a number that a user typed, with a point or a comma; returns null if it is not a number. */
export function parseNumber(text: string): number | null {
  const normalized = text.trim().replace(",", ".");
  if (normalized === "") return null;
  const value = Number(normalized);
  return Number.isFinite(value) ? value : null;
}

export function clamp(value: number, minimum: number | null, maximum: number | null): number {
  if (minimum !== null && value < minimum) return minimum;
  if (maximum !== null && value > maximum) return maximum;
  return value;
}

/** Returns the step of an arrow key for a number, by its magnitude; 1 for integers. */
export function chooseStep(value: number, isInteger: boolean): number {
  if (isInteger) return 1;
  const magnitude = Math.abs(value);
  return magnitude < 0.1 ? 0.01 : 10 ** (Math.floor(Math.log10(magnitude)) - 1);
}

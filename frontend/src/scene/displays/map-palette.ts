export type MapScheme = "map" | "costmap" | "raw";

const UNKNOWN = [0x70, 0x89, 0x86, 255] as const;

/**
 * Returns RViz's colors for the byte values of an occupancy grid: 256 times red, green, blue, alpha. `threshold` is
 * the smallest value that counts as occupied, or null for continuous shades.
 */
export function createMapPalette(scheme: MapScheme, threshold: number | null): Uint8Array {
  const palette = new Uint8Array(256 * 4);
  for (let value = 0; value < 256; value++) palette.set(colorOf(scheme, value, threshold), value * 4);
  return palette;
}

type Rgba = readonly [number, number, number, number];

function colorOf(scheme: MapScheme, value: number, threshold: number | null): Rgba {
  if (scheme === "raw") return createGray(threshold === null ? value : value < threshold ? 0 : 255);
  if (value === 255) return UNKNOWN;
  // Invalid values: green above 100, red to yellow below -1.
  if (value >= 128) return [255, Math.floor((255 * (value - 128)) / 126), 0, 255];
  if (value > 100) return [0, 255, 0, 255];
  if (threshold !== null) {
    if (scheme === "map") return createGray(value < threshold ? 255 : 0);
    return value < threshold ? [0, 0, 255, 255] : [255, 0, 0, 255];
  }
  if (scheme === "map") return createGray(255 - Math.floor((255 * value) / 100));
  if (value === 0) return [0, 0, 0, 0];
  if (value === 99) return [0, 255, 255, 255];
  if (value === 100) return [255, 0, 255, 255];
  const heat = Math.floor((255 * value) / 100);
  return [heat, 0, 255 - heat, 255];
}

function createGray(value: number): Rgba {
  return [value, value, value, 255];
}

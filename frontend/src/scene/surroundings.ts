import { Color, DataTexture, EquirectangularReflectionMapping, Fog, FogExp2, LinearFilter, type Scene } from "three";
import type { FogScene } from "../protocol";

/** What is around a world: a colour, or a sky, and fog. */
export interface Surroundings {
  readonly background: string | null;
  /** How bright the sky is, from 0 to 1; null for none. */
  readonly daylight: number | null;
  readonly fog: FogScene | null;
}

/** How a world lights the scene by itself: whether with shadows, and what is around it. */
export interface OwnLight extends Surroundings {
  readonly shadows: boolean;
}

type Rgb = readonly [number, number, number];

/** From the nadir to the zenith. */
const HEIGHT = 64;
const DAY: readonly Rgb[] = [[0.42, 0.44, 0.45], [0.8, 0.86, 0.92], [0.31, 0.52, 0.82]];
const NIGHT: readonly Rgb[] = [[0.05, 0.05, 0.06], [0.1, 0.11, 0.17], [0.02, 0.03, 0.08]];

/** Gives a scene its surroundings; what stays the same is made once. */
export class SkyAndFog {
  private sky: DataTexture | null = null;
  private made: number | null = null;
  private fogged = "";

  constructor(private readonly scene: Scene) {
    // The picture of a sky has y up.
    scene.backgroundRotation.x = Math.PI / 2;
  }

  /** `flat`: the camera sees in parallel, and of a sky the same everywhere. */
  set({ daylight, fog }: Surroundings, flat: boolean): void {
    if (daylight !== this.made) {
      this.sky?.dispose();
      this.sky = daylight === null ? null : skyOf(daylight);
      this.made = daylight;
    }
    this.scene.background = flat && daylight !== null ? horizon(daylight) : this.sky;
    const key = JSON.stringify(fog);
    if (key === this.fogged) return;
    this.fogged = key;
    this.scene.fog = fog ? fogOf(fog) : null;
  }
}

function fogOf({ color: [r = 1, g = 1, b = 1], start, end, density }: FogScene): Fog | FogExp2 {
  const hex = new Color(r, g, b).getHex();
  return density === null ? new Fog(hex, start, end) : new FogExp2(hex, density);
}

/** The colour of a sky: at -1 below, 0 at the horizon, 1 above. */
function colorAt(height: number, daylight: number): Rgb {
  const mixed = DAY.map((day, i) => mix(NIGHT[i] ?? day, day, daylight));
  const [below, middle, above] = mixed;
  const [end, share] = height < 0 ? [below, Math.min(1, -8 * height)] : [above, Math.sqrt(height)];
  return mix(middle ?? [0, 0, 0], end ?? [0, 0, 0], share);
}

function mix(a: Rgb, b: Rgb, share: number): Rgb {
  const at = (i: 0 | 1 | 2): number => a[i] + (b[i] - a[i]) * share;
  return [at(0), at(1), at(2)];
}

function horizon(daylight: number): Color {
  return new Color(...colorAt(0, daylight));
}

function skyOf(daylight: number): DataTexture {
  const pixels = new Uint8Array(4 * HEIGHT);
  for (let row = 0; row < HEIGHT; row++) {
    const rgb = colorAt(Math.sin(((row + 0.5) / HEIGHT - 0.5) * Math.PI), daylight);
    pixels.set([...rgb.map((each) => Math.round(255 * each)), 255], 4 * row);
  }
  const texture = new DataTexture(pixels, 1, HEIGHT);
  texture.mapping = EquirectangularReflectionMapping;
  texture.magFilter = texture.minFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

import { Color, DataTexture, EquirectangularReflectionMapping, Fog, FogExp2, LinearFilter, type Scene } from "three";
import type { FogScene } from "../protocol";

/** The surroundings of a world: a background color or a sky, and fog. */
export interface Surroundings {
  readonly background: string | null;
  /** The brightness of the sky, from 0 to 1; null for no sky. */
  readonly daylight: number | null;
  readonly fog: FogScene | null;
  /** A background color, brighter towards the horizon, instead of a sky. */
  readonly backdrop?: string | null;
}

/** The lighting of a world or a studio: whether it casts shadows, and its surroundings. */
export interface OwnLight extends Surroundings {
  readonly hasShadows: boolean;
}

/** Whether a world specifies its background. */
export function hasOwnBackground(light: OwnLight | null): boolean {
  return light !== null && (light.background !== null || light.daylight !== null);
}

type Rgb = readonly [number, number, number];
/** The colors at the nadir, the horizon and the zenith. */
type Sky = readonly [below: Rgb, middle: Rgb, above: Rgb];

/** The pixels of a sky texture from the nadir to the zenith. */
const SKY_HEIGHT_PX = 64;
/** The fraction of white that is mixed into a backdrop at its horizon. */
const HORIZON_BRIGHTNESS = 0.18;
const DAY_SKY: Sky = [[0.42, 0.44, 0.45], [0.8, 0.86, 0.92], [0.31, 0.52, 0.82]];
const NIGHT_SKY: Sky = [[0.05, 0.05, 0.06], [0.1, 0.11, 0.17], [0.02, 0.03, 0.08]];

/** Sets the surroundings of a scene, and keeps textures that do not change. */
export class SkyAndFog {
  private sky: DataTexture | null = null;
  private skyKey: number | string | null = null;
  private fogKey = "";

  constructor(private readonly scene: Scene) {
    // Sky textures have y up.
    scene.backgroundRotation.x = Math.PI / 2;
  }

  /**
   * Applies surroundings; `isOrthographic` for an orthographic camera, which sees the same color of a sky everywhere.
   */
  apply({ daylight, fog, backdrop = null }: Surroundings, isOrthographic: boolean): void {
    const key = daylight ?? backdrop;
    if (key !== this.skyKey) {
      this.sky?.dispose();
      this.sky = key === null ? null : createSkyTexture(typeof key === "number" ? skyForDaylight(key) : skyForColor(key));
      this.skyKey = key;
    }
    if (!isOrthographic) this.scene.background = this.sky;
    else this.scene.background = daylight === null ? null : new Color(...skyForDaylight(daylight)[1]);
    const fogKey = JSON.stringify(fog);
    if (fogKey === this.fogKey) return;
    this.fogKey = fogKey;
    this.scene.fog = fog ? createFog(fog) : null;
  }
}

function createFog({ color: [r = 1, g = 1, b = 1], start, end, density }: FogScene): Fog | FogExp2 {
  const hex = new Color(r, g, b).getHex();
  return density === null ? new Fog(hex, start, end) : new FogExp2(hex, density);
}

/** Returns the color of a sky at a height: -1 nadir, 0 horizon, 1 zenith. */
function colorAt(height: number, [nadir, horizon, zenith]: Sky): Rgb {
  return height < 0 ? mix(horizon, nadir, Math.min(1, -8 * height)) : mix(horizon, zenith, Math.sqrt(height));
}

function skyForDaylight(daylight: number): Sky {
  return [mix(NIGHT_SKY[0], DAY_SKY[0], daylight), mix(NIGHT_SKY[1], DAY_SKY[1], daylight), mix(NIGHT_SKY[2], DAY_SKY[2], daylight)];
}

/** Returns the sky of a backdrop color, brighter at the horizon. */
function skyForColor(color: string): Sky {
  const { r, g, b } = new Color(color);
  const rgb: Rgb = [r, g, b];
  return [rgb, mix(rgb, [1, 1, 1], HORIZON_BRIGHTNESS), rgb];
}

function mix(a: Rgb, b: Rgb, fraction: number): Rgb {
  const mixChannel = (i: 0 | 1 | 2): number => a[i] + (b[i] - a[i]) * fraction;
  return [mixChannel(0), mixChannel(1), mixChannel(2)];
}

function createSkyTexture(sky: Sky): DataTexture {
  const pixels = new Uint8Array(4 * SKY_HEIGHT_PX);
  for (let row = 0; row < SKY_HEIGHT_PX; row++) {
    const rgb = colorAt(Math.sin(((row + 0.5) / SKY_HEIGHT_PX - 0.5) * Math.PI), sky);
    pixels.set([...rgb.map((channel) => Math.round(255 * channel)), 255], 4 * row);
  }
  const texture = new DataTexture(pixels, 1, SKY_HEIGHT_PX);
  texture.mapping = EquirectangularReflectionMapping;
  texture.magFilter = texture.minFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

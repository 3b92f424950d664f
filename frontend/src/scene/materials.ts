import {
  Color,
  DataTexture,
  DoubleSide,
  EquirectangularReflectionMapping,
  FrontSide,
  LinearFilter,
  MeshBasicMaterial,
  MeshLambertMaterial,
  MeshStandardMaterial,
  NoColorSpace,
  RepeatWrapping,
  TextureLoader,
  type BufferAttribute,
  type InterleavedBufferAttribute,
  type Material,
  type MeshStandardMaterialParameters,
  type Texture,
} from "three";
import { applyFilmicTone } from "./filmic-tone";
import { usesSceneLights, type Lighting } from "./light";
import { softenLight } from "./soft-material";

/**
 * The reflective properties of a surface: roughness and metalness from 0 to 1, maps of these and of the normals,
 * emission, and ambient occlusion (red channel).
 */
export interface Surface {
  readonly roughness: number;
  readonly metalness: number;
  readonly normalMap: Texture | null;
  readonly roughnessMap: Texture | null;
  readonly metalnessMap: Texture | null;
  readonly emissive: readonly [number, number, number];
  readonly emissiveMap: Texture | null;
  readonly aoMap: Texture | null;
}

/** Returns the textures of a surface. */
export function texturesOf(surface: Surface | null | undefined): (Texture | null)[] {
  if (!surface) return [];
  const { normalMap, roughnessMap, metalnessMap, emissiveMap, aoMap } = surface;
  return [normalMap, roughnessMap, metalnessMap, emissiveMap, aoMap];
}

/** The look of a surface; equal looks share a material. */
export interface Look {
  color: readonly [number, number, number];
  alpha: number;
  map: Texture | null;
  hasVertexColors: boolean;
  isDoubleSided: boolean;
  /** Whether lines and marks in the same plane must remain visible. */
  isBehind?: boolean;
  /** Applies only to lights in the scene, because the camera's light is that of RViz. */
  surface?: Surface | null;
}

/** RViz's color for surfaces without a material: RVIZ/ShadedRed. */
export const RVIZ_RED = [1, 0, 0] as const;
/** Below this alpha, RViz blends and does not write depth. */
export const MIN_OPAQUE_ALPHA = 0.9998;

/** Makes a material translucent or opaque. */
export function setBlending(material: Material, isTranslucent: boolean): void {
  material.transparent = isTranslucent;
  material.depthWrite = !isTranslucent;
  material.needsUpdate = true;
}

/** Returns the polygon offset that keeps lines and marks in the plane of a surface visible. */
export function polygonOffsetOf(isBehind: boolean): { polygonOffset: boolean; polygonOffsetFactor: number; polygonOffsetUnits: number } {
  return { polygonOffset: isBehind, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };
}

/** Whether any lines are translucent, by their opacity or the alpha of their colors r g b a. */
export function areTranslucent(opacity: number, colors: BufferAttribute | InterleavedBufferAttribute | undefined): boolean {
  if (opacity < 1) return true;
  for (let i = 0; colors && i < colors.count; i++) if (colors.getW(i) < 1) return true;
  return false;
}

/** The white in which RViz draws a link without a transform. */
export const errorMaterial = new MeshBasicMaterial({ color: 0xffffff, side: DoubleSide });

/** Shares materials among surfaces with the same look. */
export class MaterialPool {
  lighting: Lighting = "Camera";
  private readonly materials = new Map<string, MeshLambertMaterial | MeshStandardMaterial>();
  private readonly usedKeys = new Set<string>();

  /** Whether lights in the scene illuminate the surfaces, so that reflective properties apply. */
  get isLit(): boolean {
    return usesSceneLights(this.lighting);
  }

  get(look: Look): Material {
    const surface = (this.isLit && look.surface) || null;
    const maps = [look.map, ...texturesOf(surface)].map((map) => map?.uuid);
    const numbers = [look.alpha, surface?.roughness, surface?.metalness, ...(surface?.emissive ?? [])];
    const key = [...look.color, ...numbers, ...maps, look.hasVertexColors, look.isDoubleSided, look.isBehind, this.lighting].join();
    this.usedKeys.add(key);
    let material = this.materials.get(key);
    if (!material) {
      const isTranslucent = look.alpha < MIN_OPAQUE_ALPHA;
      const style = {
        color: new Color(...look.color),
        opacity: look.alpha,
        transparent: isTranslucent,
        depthWrite: !isTranslucent,
        map: look.map,
        vertexColors: look.hasVertexColors,
        side: look.isDoubleSided ? DoubleSide : FrontSide,
        ...polygonOffsetOf(look.isBehind === true),
      };
      material = surface ? createReflectiveMaterial(style, surface) : new MeshLambertMaterial(style);
      if (this.lighting === "Studio") applyFilmicTone(material);
      else if (this.lighting === "Soft") softenLight(material);
      this.materials.set(key, material);
    }
    return material;
  }

  /** Runs `paint`, which requests every material still needed, and disposes of the others. */
  repaint(paint: () => void): void {
    this.usedKeys.clear();
    paint();
    for (const [key, material] of this.materials) {
      if (this.usedKeys.has(key)) continue;
      material.dispose();
      this.materials.delete(key);
    }
  }

  dispose(): void {
    for (const material of this.materials.values()) material.dispose();
    this.materials.clear();
  }
}

/** Returns a material that reflects lights and, as far as it is metallic, its environment: a gray room. */
function createReflectiveMaterial(style: MeshStandardMaterialParameters, surface: Surface): MeshStandardMaterial {
  const envMap = surface.metalness > 0 ? getEnvironmentMap() : null;
  const emissive = new Color(...surface.emissive);
  const material = new MeshStandardMaterial({ ...style, ...surface, emissive, envMap, envMapIntensity: surface.metalness });
  material.envMapRotation.x = Math.PI / 2; // the image has y up
  return material;
}

let environmentMap: DataTexture | null = null;

/**
 * Returns the environment map that metal reflects in addition to lights; it would be black without one. The map is
 * bright above and dark below.
 */
function getEnvironmentMap(): DataTexture {
  if (environmentMap) return environmentMap;
  const grays = [90, 90, 110, 150, 190, 215, 230, 240];
  environmentMap = new DataTexture(new Uint8Array(grays.flatMap((gray) => [gray, gray, gray, 255])), 1, grays.length);
  environmentMap.mapping = EquirectangularReflectionMapping;
  environmentMap.magFilter = environmentMap.minFilter = LinearFilter;
  environmentMap.needsUpdate = true;
  return environmentMap;
}

/** Loads the texture of a URDF material. */
export async function loadTexture(url: string): Promise<Texture> {
  const texture = await new TextureLoader().loadAsync(url);
  texture.colorSpace = NoColorSpace;
  texture.wrapS = texture.wrapT = RepeatWrapping;
  return texture;
}

import {
  Color,
  DoubleSide,
  FrontSide,
  MeshBasicMaterial,
  MeshLambertMaterial,
  NoColorSpace,
  RepeatWrapping,
  TextureLoader,
  type BufferAttribute,
  type InterleavedBufferAttribute,
  type Material,
  type Texture,
} from "three";

/** What a surface looks like; equal looks share one material. */
export interface Look {
  color: readonly [number, number, number];
  alpha: number;
  map: Texture | null;
  vertexColors: boolean;
  doubleSided: boolean;
  /** Lines and marks in the same plane are seen on it. */
  behind?: boolean;
}

/** RViz's material for what has none: RVIZ/ShadedRed. */
export const RVIZ_RED = [1, 0, 0] as const;
/** Below this alpha RViz blends and stops writing depth. */
export const OPAQUE_FROM = 0.9998;

/** Lets what is behind a surface be seen, or no more. */
export function blend(material: Material, seeThrough: boolean): void {
  material.transparent = seeThrough;
  material.depthWrite = !seeThrough;
  material.needsUpdate = true;
}

/** Whether lines are seen through: all of them, or some, by the alpha of their colours r g b a. */
export function areSeenThrough(opacity: number, colors: BufferAttribute | InterleavedBufferAttribute | undefined): boolean {
  if (opacity < 1) return true;
  for (let i = 0; colors && i < colors.count; i++) if (colors.getW(i) < 1) return true;
  return false;
}

/** RViz's white of a link without a transform. */
export const errorMaterial = new MeshBasicMaterial({ color: 0xffffff, side: DoubleSide });

/** Hands out materials; many links of one colour make one material. */
export class MaterialPool {
  /** Whether lights that stand in the scene shine on the surfaces, so that each is to be drawn by itself. */
  isLit = false;
  private readonly materials = new Map<string, MeshLambertMaterial>();
  private readonly used = new Set<string>();

  get(look: Look): Material {
    const key = [...look.color, look.alpha, look.map?.uuid, look.vertexColors, look.doubleSided, look.behind].join();
    this.used.add(key);
    let material = this.materials.get(key);
    if (!material) {
      const seeThrough = look.alpha < OPAQUE_FROM;
      material = new MeshLambertMaterial({
        color: new Color(...look.color),
        opacity: look.alpha,
        transparent: seeThrough,
        depthWrite: !seeThrough,
        map: look.map,
        vertexColors: look.vertexColors,
        side: look.doubleSided ? DoubleSide : FrontSide,
        polygonOffset: look.behind === true,
        polygonOffsetFactor: 1,
        polygonOffsetUnits: 1,
      });
      this.materials.set(key, material);
    }
    return material;
  }

  /** Runs `paint`, which asks for every material still wanted, and lets go of the others. */
  renew(paint: () => void): void {
    this.used.clear();
    paint();
    for (const [key, material] of this.materials) {
      if (this.used.has(key)) continue;
      material.dispose();
      this.materials.delete(key);
    }
  }

  dispose(): void {
    for (const material of this.materials.values()) material.dispose();
    this.materials.clear();
  }
}

/** Loads the texture of a URDF material. */
export async function loadTexture(url: string): Promise<Texture> {
  const texture = await new TextureLoader().loadAsync(url);
  texture.colorSpace = NoColorSpace;
  texture.wrapS = texture.wrapT = RepeatWrapping;
  return texture;
}

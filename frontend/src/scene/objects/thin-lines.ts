import {
  BufferAttribute,
  BufferGeometry,
  Color,
  LineBasicMaterial,
  LineSegments,
  type Box3,
  type ColorRepresentation,
} from "three";
import { areTranslucent, setBlending } from "../materials";
import { splitIntoSegments } from "./ribbons";

/** Lines one pixel wide, unlit; with the same methods as `WideLines`. */
export class ThinLines {
  readonly root = new LineSegments<BufferGeometry, LineBasicMaterial>(new BufferGeometry(), new LineBasicMaterial());
  private opacity = 1;
  private isEnabled = true;

  constructor() {
    this.root.frustumCulled = false;
    this.root.visible = false;
  }

  /** Sets segments by x y z of both ends of each; `colors` has r g b a of both ends, 0 to 1. */
  setSegments(segments: Float32Array, colors: Float32Array | null = null): void {
    const geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(segments, 3));
    if (colors) geometry.setAttribute("color", new BufferAttribute(colors, 4));
    this.root.geometry.dispose();
    this.root.geometry = geometry;
    this.updateVisibility();
    this.updateMaterial();
  }

  /** The number of segments. */
  get count(): number {
    return (this.root.geometry.attributes["position"]?.count ?? 0) / 2;
  }

  /** Whether the lines are shown. */
  set isShown(isShown: boolean) {
    this.isEnabled = isShown;
    this.updateVisibility();
  }

  /**
   * Sets lines through the points of each strip; `colors` has r g b a of each point, 0 to 1, multiplied by the style's
   * color.
   */
  setStrips(strips: readonly Float32Array[], colors: readonly Float32Array[] | null = null): void {
    this.setSegments(
      concatenate(strips.map((strip) => splitIntoSegments(strip))),
      colors && concatenate(colors.map((color) => splitIntoSegments(color, 4))),
    );
  }

  setStyle(color: ColorRepresentation, opacity: number): void {
    this.root.material.color = new Color(color);
    this.root.material.opacity = opacity;
    this.opacity = opacity;
    this.updateMaterial();
  }

  /** Expands `box` by all lines, in the world frame. */
  expandBox(box: Box3): void {
    if (this.root.visible) box.expandByObject(this.root);
  }

  dispose(): void {
    this.root.removeFromParent();
    this.root.geometry.dispose();
    this.root.material.dispose();
  }

  private updateVisibility(): void {
    this.root.visible = this.isEnabled && this.count > 0;
  }

  private updateMaterial(): void {
    const { material, geometry } = this.root;
    const colors = geometry.attributes["color"];
    material.vertexColors = colors !== undefined;
    setBlending(material, areTranslucent(this.opacity, colors));
  }
}

/** Concatenates arrays. */
export function concatenate(parts: readonly Float32Array[]): Float32Array {
  const result = new Float32Array(parts.reduce((sum, part) => sum + part.length, 0));
  let offset = 0;
  for (const part of parts) {
    result.set(part, offset);
    offset += part.length;
  }
  return result;
}

import { BoxGeometry, BufferGeometry, EdgesGeometry, Float32BufferAttribute, LineBasicMaterial, LineSegments } from "three";

const EDGE_ENDPOINTS = new EdgesGeometry(new BoxGeometry(1, 1, 1)).getAttribute("position").array as Float32Array;

/** The edges of axis-aligned cubes, visible through everything: RViz's marks of selected points. */
export class WireBoxes {
  readonly root = new LineSegments(
    new BufferGeometry(),
    new LineBasicMaterial({ color: 0x00ffff, depthTest: false, transparent: true }),
  );

  constructor() {
    this.root.visible = false;
    this.root.frustumCulled = false;
    this.root.renderOrder = 9;
  }

  /** Sets the cubes: x y z of the center of each, and the length of their sides, m. */
  set(centers: readonly number[], side: number): void {
    const corners = new Float32Array((centers.length / 3) * EDGE_ENDPOINTS.length);
    for (let i = 0; i < corners.length; i++) {
      const cube = Math.floor(i / EDGE_ENDPOINTS.length);
      corners[i] = (centers[cube * 3 + (i % 3)] ?? 0) + (EDGE_ENDPOINTS[i % EDGE_ENDPOINTS.length] ?? 0) * side;
    }
    this.root.geometry.dispose();
    this.root.geometry = new BufferGeometry().setAttribute("position", new Float32BufferAttribute(corners, 3));
    this.root.visible = corners.length > 0;
  }

  dispose(): void {
    this.root.removeFromParent();
    this.root.geometry.dispose();
    this.root.material.dispose();
  }
}

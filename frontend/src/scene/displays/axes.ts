import { Box3, Group, Mesh, MeshLambertMaterial } from "three";
import { FIXED_FRAME } from "../../state/view";
import { createAxes } from "../objects/geometries";
import { readFramePose } from "../pose";
import type { Drawing, DrawingContext } from "./drawing";

const SEGMENT_COUNT = 24;

/** rviz_default_plugins/Axes */
export class AxesDrawing implements Drawing {
  readonly root = new Group();
  private readonly mesh = new Mesh(undefined, new MeshLambertMaterial({ vertexColors: true }));
  private frame = "";

  constructor(private readonly context: DrawingContext) {
    this.root.matrixAutoUpdate = false;
    this.root.add(this.mesh);
    this.onPropertiesChanged();
  }

  onPropertiesChanged(): void {
    const { rows } = this.context.display;
    this.mesh.geometry.dispose();
    this.mesh.geometry = createAxes(rows.number(1, "Length"), rows.number(0.1, "Radius"), SEGMENT_COUNT);
    this.frame = rows.text(FIXED_FRAME, "Reference Frame");
  }

  update(): void {
    const { frames, displays } = this.context.session;
    const isInFixedFrame = this.frame === FIXED_FRAME || this.frame === displays.fixedFrame;
    if (isInFixedFrame) this.root.matrix.identity();
    this.mesh.visible = isInFixedFrame || readFramePose(frames, frames.rowOf(this.frame), this.root.matrix);
    this.root.matrixWorldNeedsUpdate = true;
  }

  /** Returns the bounds in the fixed frame; null without a transform. */
  inspect(): object {
    if (!this.mesh.visible) return { bounds: null };
    this.mesh.updateWorldMatrix(true, false);
    const { min, max } = new Box3().setFromObject(this.mesh);
    return { bounds: { min: min.toArray(), max: max.toArray() } };
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}

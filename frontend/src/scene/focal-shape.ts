import { Mesh, MeshLambertMaterial } from "three";
import type { ViewState } from "../state/view";
import { readNumber } from "../state/views/view-controller";
import { unitSphere } from "./objects/geometries";

/** The disc at the focal point, visible only while the view is being dragged. */
export class FocalShape {
  readonly root = new Mesh(
    unitSphere,
    new MeshLambertMaterial({ color: 0xffff00, opacity: 0.5, transparent: true, depthWrite: false }),
  );

  /** Whether the disc is to be visible, provided the view has a focal point. */
  isShown = false;

  constructor() {
    this.root.visible = false;
  }

  updatePose(view: ViewState): void {
    const { values, controller, camera } = view;
    this.root.visible = this.isShown && camera.focal !== null;
    if (!camera.focal) return;
    const hasFixedSize = values["Focal Shape Fixed Size"] !== false;
    const diameter = readNumber(values, "Focal Shape Size", 0.05) * (hasFixedSize ? 1 : readNumber(values, "Distance", 1));
    this.root.position.set(...camera.focal);
    this.root.scale.set(diameter / 2, diameter / 2, diameter / 10);
    this.root.material.color.set(controller.focalColor);
  }
}

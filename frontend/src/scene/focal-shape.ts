import { Mesh, MeshLambertMaterial } from "three";
import type { ViewState } from "../state/view";
import { unitSphere } from "./objects/geometries";

/** The yellow disc at the focal point, seen only while the view is being dragged. */
export class FocalShape {
  readonly root = new Mesh(
    unitSphere,
    new MeshLambertMaterial({ color: 0xffff00, opacity: 0.5, transparent: true, depthWrite: false }),
  );

  constructor() {
    this.root.visible = false;
  }

  place(view: ViewState): void {
    const { focal_shape_size, focal_shape_fixed_size, distance } = view.current;
    const diameter = focal_shape_size * (focal_shape_fixed_size ? 1 : distance);
    const target = view.targetPosition();
    const { focal } = view.orbit;
    this.root.position.set(target[0] + focal[0], target[1] + focal[1], target[2] + focal[2]);
    this.root.scale.set(diameter / 2, diameter / 2, diameter / 10);
  }
}

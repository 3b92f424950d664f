import { Sphere } from "three";
import type { Stage } from "../scene/stage";
import type { Session } from "../state/session";
import { FIELD_OF_VIEW } from "../state/views/camera";

const ORBIT = "rviz_default_plugins/Orbit";
/** Room around the robot. */
const MARGIN = 1.25;

export type Side = "front" | "left" | "top" | "iso";

const SIDES: Readonly<Record<Side, { Yaw: number; Pitch: number }>> = {
  front: { Yaw: 0, Pitch: 0 },
  left: { Yaw: Math.PI / 2, Pitch: 0 },
  top: { Yaw: Math.PI, Pitch: Math.PI / 2 - 0.001 },
  iso: { Yaw: Math.PI / 4, Pitch: 0.5 },
};

/** Looks at all of the robot from a side. */
export function lookFrom(side: Side, session: Session, stage: Stage, display: string): void {
  const around = stage.boundsOf(display).getBoundingSphere(new Sphere());
  if (around.radius <= 0) return;
  const { width, height } = stage.viewport.size;
  const half = Math.atan(Math.tan(FIELD_OF_VIEW / 2) * Math.min(1, width / height));
  const { x, y, z } = around.center;
  session.view.setClass(ORBIT);
  session.view.update({
    ...SIDES[side],
    Distance: (around.radius * MARGIN) / Math.sin(half),
    "Focal Point/X": x,
    "Focal Point/Y": y,
    "Focal Point/Z": z,
  });
}

import type { Stage } from "../scene/stage";
import type { Session } from "../state/session";

const ORBIT_CLASS = "rviz_default_plugins/Orbit";

export type Side = "front" | "left" | "top" | "iso";

const SIDE_ANGLES: Readonly<Record<Side, { Yaw: number; Pitch: number }>> = {
  front: { Yaw: 0, Pitch: 0 },
  left: { Yaw: Math.PI / 2, Pitch: 0 },
  top: { Yaw: Math.PI, Pitch: Math.PI / 2 - 0.001 },
  iso: { Yaw: Math.PI / 4, Pitch: 0.5 },
};

/** Looks at the whole robot from a side. */
export function lookFrom(side: Side, session: Session, stage: Stage): void {
  session.view.setClass(ORBIT_CLASS);
  session.view.update(SIDE_ANGLES[side]);
  stage.fitRobots();
}

import type { StatusLevel, StatusRow } from "./protocol.gen";
import type { Stage } from "./scene/stage";
import type { FramePose } from "./state/frames";
import type { Session } from "./state/session";

/** What tests and curious users read as `window.linkwright`; every value is a copy made when it is read. */
export interface Inspection {
  /** The robot, its meshes and its first transforms were drawn. */
  readonly ready: boolean;
  /** Pose of every frame in the fixed frame, m and xyzw. */
  readonly frames: Record<string, FramePose>;
  /** The first robot shown; `visuals` is how many of its visuals are drawn now. */
  readonly robot: { name: string; links: number; visuals: number } | null;
  readonly displays: {
    name: string;
    class: string;
    enabled: boolean;
    level: StatusLevel;
    status: StatusRow[];
  }[];
  readonly view: {
    type: string;
    yaw: number;
    pitch: number;
    distance: number;
    focalPoint: [number, number, number];
  };
  /** Joint positions of the Joints panel, rad or m. */
  readonly joints: Record<string, number>;
  readonly selected: { link: string; file: string | null; line: number | null; column: number | null } | null;
  readonly framesDrawn: number;
}

declare global {
  interface Window {
    readonly linkwright: Inspection;
  }
}

/** Publishes `window.linkwright`. */
export function publishInspection(session: Session, stage: Stage | null): void {
  const inspection: Inspection = {
    get ready() {
      return stage?.ready ?? false;
    },
    get frames() {
      return session.frames.snapshot();
    },
    get robot() {
      const { robot } = session;
      return robot && { name: robot.name, links: robot.links.length, visuals: stage?.visualsDrawn ?? 0 };
    },
    get displays() {
      return session.displays.displays.map(({ name, cls, enabled, level, status }) => ({
        name,
        class: cls,
        enabled,
        level,
        status: status.map((row) => ({ ...row })),
      }));
    },
    get view(): Inspection["view"] {
      const { yaw, pitch, distance, focal } = session.view.orbit;
      const type = session.view.current.cls.split("/").pop() ?? "";
      return { type, yaw, pitch, distance, focalPoint: [focal[0], focal[1], focal[2]] };
    },
    get joints() {
      return { ...session.joints.positions };
    },
    get selected() {
      const link = session.selection.selected?.link;
      if (!link) return null;
      const { file = null, line = null, column = null } = link.place ?? {};
      return { link: link.name, file, line, column };
    },
    get framesDrawn() {
      return stage?.loop.framesDrawn ?? 0;
    },
  };
  Object.defineProperty(window, "linkwright", { value: Object.freeze(inspection), enumerable: true });
}

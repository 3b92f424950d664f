import type { PropertyValue, StatusLevel, StatusRow } from "./protocol";
import type { Stage } from "./scene/stage";
import type { Toolbox } from "./scene/tools/toolbox";
import type { FramePose } from "./state/frames";
import type { SelectedItem } from "./state/selection";
import type { Session } from "./state/session";
import type { Camera } from "./state/views/camera";
import { shortNameOf } from "./state/views/catalog";
import { readNumber, readVector } from "./state/views/view-controller";

/**
 * The value of `window.linkwright`, for tests and curious users; each property is a copy made at the time of reading.
 */
interface Inspection {
  /** Whether the robot has been drawn with its meshes and first transforms. */
  readonly ready: boolean;
  /** Whether the last frame shows all data received, so that no further frame is due. */
  readonly settled: boolean;
  /** The number of the server's messages processed since the connection was opened. */
  readonly received: number;
  /** The pose of every frame in the fixed frame, m and xyzw. */
  readonly frames: Record<string, FramePose>;
  /** The first robot shown; `visuals` is the number of its visuals that are drawn now. */
  readonly robot: { name: string; links: number; visuals: number } | null;
  readonly displays: {
    name: string;
    class: string;
    enabled: boolean;
    level: StatusLevel;
    status: StatusRow[];
    /** The drawing's own report: counts, bounds, colors. */
    drawn: object | null;
  }[];
  readonly view: {
    type: string;
    yaw: number;
    pitch: number;
    distance: number;
    focalPoint: [number, number, number];
    /** All values, by the paths of their properties. */
    values: Record<string, PropertyValue>;
    /** The camera in the fixed frame. */
    camera: Camera;
    saved: string[];
  };
  /** The active tool; `state` is its own report. */
  readonly tool: { class: string | null; hint: string; cursor: string; state: object | null };
  readonly tools: string[];
  /** All selected objects. */
  readonly selection: SelectedItem[];
  /** The recording or the history shown: times in s since its start. `sizeBytes` is the history's size. */
  readonly timeline: { name: string; position: number; length: number; playing: boolean; problem: string; live: boolean; sizeBytes: number } | null;
  /** The recording in progress, the marked part of the history (s since its start), and why recording failed. */
  readonly recording: { path: string; length: number; saved: number | null; problem: string; files: string[]; mark: number[] | null };
  readonly time: { paused: boolean; mode: string; source: string; sources: string[] };
  /** The joint positions of the Joints panel, rad or m. */
  readonly joints: Record<string, number>;
  /** The description of the first robot, and the link or joint that the panels show. */
  readonly description: {
    revision: number;
    links: number;
    joints: number;
    /** The link or joint that the panels show. */
    focus: { kind: string; name: string } | null;
    /** Links and joints that edits have changed, in the order of the edits. */
    edited: string[];
    findings: { link: string; code: string }[];
  };
  readonly panels: Record<string, object>;
  /** The drawn marks of invisible properties: masses, inertias, joint axes. */
  readonly invisibleProperties: object | null;
  readonly selected: { link: string; file: string | null; line: number | null; column: number | null } | null;
  readonly framesDrawn: number;
  /** The rightmost pixel column that robots cover, from the left edge of the canvas. */
  readonly robotsRightEdge: number;
  /** The time of the newest transforms, s. */
  readonly stamp: number;
}

declare global {
  interface Window {
    readonly linkwright: Inspection;
  }
}

/** Publishes `window.linkwright`. */
export function publishInspection(
  session: Session,
  stage: Stage | null,
  toolbox: Toolbox | null,
  panels: Readonly<Record<string, () => object>>,
): void {
  const edited: string[] = [];
  session.description.edited.on(({ links, joints }) => edited.push(...links, ...joints));
  const inspection: Inspection = {
    get ready() {
      return stage?.isReady ?? false;
    },
    get settled() {
      return stage?.isSettled ?? false;
    },
    get received() {
      return session.connection.received;
    },
    get frames() {
      return session.frames.snapshot();
    },
    get robot() {
      const { robot } = session;
      return robot && { name: robot.name, links: robot.links.length, visuals: stage?.visualsDrawn ?? 0 };
    },
    get displays() {
      return session.displays.displays.map(({ id, name, cls, isEnabled, level, status }) => ({
        name,
        class: cls,
        enabled: isEnabled,
        level,
        status: status.map((row) => ({ ...row })),
        drawn: stage?.inspect(id) ?? null,
      }));
    },
    get view(): Inspection["view"] {
      const { current, values, camera, savedViews } = session.view;
      const [x, y, z] = readVector(values, "Focal Point", [0, 0, 0]);
      return {
        type: shortNameOf(current.cls),
        yaw: readNumber(values, "Yaw", 0),
        pitch: readNumber(values, "Pitch", 0),
        distance: readNumber(values, "Distance", 0),
        focalPoint: [x, y, z],
        values: { ...values },
        camera,
        saved: savedViews.map(({ view }) => view.name),
      };
    },
    get tool() {
      const { current, hint } = session.tools;
      const cursor = stage?.viewport.canvas.style.cursor ?? "";
      return { class: current?.cls ?? null, hint, cursor, state: toolbox?.current.inspect?.() ?? null };
    },
    get tools() {
      return session.tools.tools.map(({ cls }) => cls);
    },
    get selection() {
      return session.selection.items.map((item) => ({ ...item }));
    },
    get timeline() {
      const { timeline, position, isPlaying, problem, isLive, extent } = session.timeline;
      if (!timeline) return null;
      const { name, start, end } = timeline;
      return { name, position: position - start, length: end - start, playing: isPlaying, problem, live: isLive, sizeBytes: extent?.size ?? 0 };
    },
    get recording() {
      const { path, length, savedShare, problem, files } = session.recording;
      const { mark, timeline } = session.timeline;
      const start = timeline?.start ?? 0;
      return { path, length, saved: savedShare, problem, files: files.map((file) => file.path), mark: mark && [mark.start - start, mark.end - start] };
    },
    get time() {
      const { isPaused, mode, source, sources } = session.time;
      return { paused: isPaused, mode, source, sources: [...sources] };
    },
    get joints() {
      return { ...session.joints.positions };
    },
    get description() {
      const display = session.robot?.display ?? "";
      const model = session.description.modelOf(display);
      const { current } = session.focus;
      return {
        revision: model?.description.revision ?? 0,
        links: model?.links.size ?? 0,
        joints: model?.joints.size ?? 0,
        focus: current && { kind: current.kind, name: current.name },
        edited: [...edited],
        findings: session.description.findingsOf(display).map(({ link, code }) => ({ link, code })),
      };
    },
    get panels() {
      return Object.fromEntries(Object.entries(panels).map(([name, inspect]) => [name, inspect()]));
    },
    get invisibleProperties() {
      return stage?.invisibleProperties ?? null;
    },
    get selected() {
      const link = session.selection.selectedLink?.link;
      if (!link) return null;
      const { file = null, line = null, column = null } = link.place ?? {};
      return { link: link.name, file, line, column };
    },
    get stamp() {
      return session.frames.stamp;
    },
    get framesDrawn() {
      return stage?.loop.framesDrawn ?? 0;
    },
    get robotsRightEdge() {
      return stage?.uncoveredArea.robotsRightEdge ?? 0;
    },
  };
  Object.defineProperty(window, "linkwright", { value: Object.freeze(inspection), enumerable: true });
}

import type { JointScene } from "../../protocol";
import type { DisplayState } from "../../state/displays";
import type { FrameStore } from "../../state/frames";
import { composePoses, computeRelativePose, type PoseNumbers } from "../../state/pose-numbers";
import type { PropertyNode } from "../../state/properties";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import type { DetailName } from "../../strings/en/details";
import { formatNumber } from "../../tree/numbers";
import type { TreeItem } from "../../tree/tree-item";

/** Positions (m) and quaternions are rounded to multiples of this. */
const ROUNDING_STEP = 1e-6;

/**
 * Returns the read-only rows below a row with `details`: the current pose of a frame, link or joint. The page has the
 * poses; the server would have to send these rows with every movement. Names and forms are RViz's.
 */
export function createDetailRows(node: PropertyNode, display: DisplayState, session: Session): TreeItem[] {
  switch (node.details) {
    case "frame":
      return createFrameRows(node, session.frames);
    case "link":
      return createPoseRows(node.id, () => computeLinkPose(node.name, display, session));
    case "joint":
      return createJointRows(node, display, session);
    case "effort":
      return createEffortRows(node, display, session);
    case null:
      return [];
  }
}

function createFrameRows({ id, name }: PropertyNode, frames: FrameStore): TreeItem[] {
  const findParentRow = (): number => frames.parents[frames.rowOf(name)] ?? -1;
  const computePoseInParent = (): PoseNumbers | null => {
    const [parentPose, framePose] = [framePoseOf(frames, findParentRow()), framePoseOf(frames, frames.rowOf(name))];
    return parentPose && framePose ? computeRelativePose(parentPose, framePose) : null;
  };
  return [
    createTextRow(`${id}#Parent`, "Parent", () => frames.names[findParentRow()] ?? ""),
    ...createPoseRows(id, () => framePoseOf(frames, frames.rowOf(name))),
    ...createPoseRows(id, computePoseInParent, "Relative "),
  ];
}

function createJointRows({ id, name }: PropertyNode, display: DisplayState, session: Session): TreeItem[] {
  const joint = session.robots.get(display.id)?.joints.find((candidate) => candidate.name === name);
  if (!joint) return [];
  const rows = [
    ...createPoseRows(id, () => computeJointPose(joint, display, session)),
    createTextRow(`${id}#Type`, "Type", () => joint.kind),
  ];
  if (joint.lower !== null) rows.push(createNumberRow(`${id}#Lower Limit`, "Lower Limit", () => joint.lower));
  if (joint.upper !== null) rows.push(createNumberRow(`${id}#Upper Limit`, "Upper Limit", () => joint.upper));
  if (joint.kind !== "fixed" && joint.kind !== "floating") {
    rows.push(createVectorRow(`${id}#Joint Axis`, "Joint Axis", ["X", "Y", "Z"], () => joint.axis));
  }
  return rows;
}

function createEffortRows({ id, name }: PropertyNode, display: DisplayState, session: Session): TreeItem[] {
  const findLatestEffort = (): { effort: number; limit: number } | null => {
    let newestEffort: { effort: number; limit: number } | null = null;
    let stamp = -Infinity;
    for (const { content, stamp: contentStamp } of session.data.contentsOf(display.id)) {
      if (content.kind !== "effort_rings" || contentStamp < stamp) continue;
      const i = content.joints.indexOf(name);
      if (i < 0) continue;
      newestEffort = { effort: content.efforts[i] ?? 0, limit: content.limits[i] ?? 0 };
      stamp = contentStamp;
    }
    return newestEffort;
  };
  return [
    createNumberRow(`${id}#Effort`, "Effort", () => findLatestEffort()?.effort ?? 0),
    createNumberRow(`${id}#Max Effort`, "Max Effort", () => findLatestEffort()?.limit ?? 0),
  ];
}

function createPoseRows(id: string, readPose: () => PoseNumbers | null, prefix = ""): TreeItem[] {
  const [position, orientation] = [`${prefix}Position`, `${prefix}Orientation`];
  return [
    createVectorRow(`${id}#${position}`, position, ["X", "Y", "Z"], () => roundPose(readPose())?.slice(0, 3) ?? null),
    createVectorRow(`${id}#${orientation}`, orientation, ["X", "Y", "Z", "W"], () => roundPose(readPose())?.slice(3) ?? null),
  ];
}

/** Rounds away what single precision adds to zeros. */
function roundPose(pose: PoseNumbers | null): number[] | null {
  return pose && pose.map((component) => Math.round(component / ROUNDING_STEP) * ROUNDING_STEP);
}

/** Returns a row with numbers in RViz's notation, with one row for each number below it. */
function createVectorRow(
  key: string,
  name: string,
  componentNames: readonly string[],
  readNumbers: () => readonly number[] | null,
): TreeItem {
  return {
    ...createTextRow(key, name, () => readNumbers()?.map(formatNumber).join("; ") ?? ""),
    get value() {
      return readNumbers()?.map(formatNumber).join("; ") ?? "";
    },
    children: () => componentNames.map((componentName, i) => createNumberRow(`${key}/${componentName}`, componentName, () => readNumbers()?.[i] ?? null)),
  };
}

function createNumberRow(key: string, name: string, readNumber: () => number | null): TreeItem {
  return createTextRow(key, name, () => {
    const value = readNumber();
    return value === null ? "" : formatNumber(value);
  });
}

function createTextRow(key: string, name: string, readText: () => string): TreeItem {
  return {
    key,
    name,
    kind: "string",
    get value() {
      return readText();
    },
    description: name in strings.details ? strings.details[name as DetailName] : "",
    isReadOnly: true,
    isLive: true,
  };
}

function computeLinkPose(name: string, display: DisplayState, { robots, frames }: Session): PoseNumbers | null {
  const link = robots.get(display.id)?.links.find((candidate) => candidate.name === name);
  return link ? framePoseOf(frames, frames.rowOf(link.frame)) : null;
}

function computeJointPose(joint: JointScene, display: DisplayState, session: Session): PoseNumbers | null {
  const parentPose = computeLinkPose(joint.parent, display, session);
  const [x = 0, y = 0, z = 0] = joint.position;
  const [qx = 0, qy = 0, qz = 0, qw = 1] = joint.quaternion;
  return parentPose && composePoses(parentPose, [x, y, z, qx, qy, qz, qw]);
}

function framePoseOf(frames: FrameStore, row: number): PoseNumbers | null {
  if (!frames.hasPose(row)) return null;
  const [x = 0, y = 0, z = 0, qx = 0, qy = 0, qz = 0, qw = 1] = frames.poses.subarray(row * 7, row * 7 + 7);
  return [x, y, z, qx, qy, qz, qw];
}

import { BufferGeometry, Line, LineBasicMaterial, Matrix4, Quaternion, Vector3 } from "three";
import type { EditablePart } from "../../protocol";
import type { Draft, EditingState } from "../../state/editing/editing";
import { findNearestRpy, quaternionOf } from "../../state/editing/rotation";
import { snap } from "../../state/modeling/snapping";
import type { Session } from "../../state/session";
import { RobotModelDrawing } from "../displays/robot-model";
import { Gizmo } from "../modeling/gizmo";
import { boundsOf } from "../initial-view";
import { readFramePose, setPoseMatrix } from "../pose";
import type { Stage } from "../stage";
import type { ToolEvent } from "../tools/tool";

/**
 * Without a grid, dragged values are rounded to these steps: m, rad (a hundredth of a degree), and components of an
 * axis.
 */
const LENGTH_ROUNDING_M = 1e-4;
const ANGLE_ROUNDING_RAD = Math.PI / 18000;
const AXIS_ROUNDING = 1e-4;
/** The minimum distance between the center of the handles and an edge of the canvas, pixels. */
const MIN_MARGIN_PX = 40;
const AXIS_COLOR = 0xff9d3c;
const ONE = new Vector3(1, 1, 1);

/**
 * The handles on the edited part, and a preview of the edited robot in this page, until the files contain the change.
 */
export class PartHandles {
  private readonly gizmo: Gizmo;
  private readonly axis = new Line(new BufferGeometry(), new LineBasicMaterial({ color: AXIS_COLOR, depthTest: false }));
  private readonly editing: EditingState;
  /** The handles' pose and the part at the start of a drag; null while no handle is held. */
  private dragStart: { handles: Matrix4; draft: Draft } | null = null;
  private previewedDisplay: string | null = null;
  /** The part that the camera was last moved to. The camera does not return to it after the user looks away. */
  private framedPart = "";

  constructor(
    private readonly stage: Stage,
    private readonly session: Session,
  ) {
    this.gizmo = new Gizmo(stage);
    this.editing = session.editing;
    this.axis.renderOrder = 1;
    this.axis.visible = false;
    this.axis.frustumCulled = false;
    stage.overlays.add(this.axis);
    const update = (): void => this.update();
    for (const signal of [this.editing.changed, this.editing.draftChanged, session.frames.posesChanged, session.frames.tableChanged]) signal.on(update);
    this.update();
  }

  /** Handles an event; returns false if it is left to others. */
  onPointer(event: ToolEvent): boolean {
    const { gizmo } = this;
    if (gizmo.isHeld) {
      if (event.type === "move") this.drag(event);
      else if (event.type === "up" && event.button === "left") this.release(event);
      return true;
    }
    if (!this.editing.isActive || !this.editing.chosenPart || this.editing.unavailableReason !== "") return false;
    if (event.type === "down" && event.button === "left") {
      const { currentDraft } = this;
      if (!currentDraft || !gizmo.grab(event)) return false;
      this.dragStart = { handles: gizmo.pose, draft: currentDraft };
      return true;
    }
    if (event.type !== "move" || event.isLeftDown || event.isMiddleDown || event.isRightDown || !gizmo.hover(event)) return false;
    this.stage.viewport.canvas.style.cursor = "grab";
    return true;
  }

  /** Returns the requested pose, and the positions of the handles on the canvas, for tests. */
  inspect(): object {
    const axes = { x: new Vector3(1, 0, 0), y: new Vector3(0, 1, 0), z: new Vector3(0, 0, 1) };
    const handles = Object.entries(axes).map(([name, axis]) => [name, this.gizmo.positionOf(axis)] as const);
    return { draft: this.editing.draft, handles: Object.fromEntries(handles) };
  }

  private get currentDraft(): Draft | null {
    return this.editing.draft ?? this.editing.chosenPart;
  }

  private update(): void {
    const { editing, gizmo, currentDraft } = this;
    const { chosenPart } = editing;
    if (editing.draft) this.session.view.keepCamera();
    const shownPart = editing.isActive && chosenPart && currentDraft && editing.unavailableReason === "" ? chosenPart : null;
    this.preview(shownPart);
    if (gizmo.isHeld) return;
    const base = shownPart && this.basePoseOf(shownPart);
    if (!shownPart) this.framedPart = "";
    if (!shownPart || !currentDraft || !base) {
      gizmo.show(null, "translate");
      this.axis.visible = false;
      return;
    }
    const pose = base.clone().multiply(createPartMatrix(shownPart, currentDraft));
    if (editing.frame === "parent" && shownPart.part !== "axis") {
      const rotation = new Quaternion().setFromRotationMatrix(base);
      pose.compose(new Vector3().setFromMatrixPosition(pose), rotation, ONE);
    }
    gizmo.show(pose, editing.mode, "local");
    this.showAxis(shownPart, currentDraft, base);
    this.frameHandles(shownPart);
  }

  /**
   * Moves the camera back until the handles of a newly chosen part are visible together with the robot, if they are not
   * in view.
   */
  private frameHandles({ part, name, index }: EditablePart): void {
    const partKey = [part, name, index].join(" ");
    if (partKey === this.framedPart) return;
    this.framedPart = partKey;
    const { x, y } = this.gizmo.positionOf(new Vector3());
    const { width, height } = this.stage.viewport.size;
    const margin = Math.min(MIN_MARGIN_PX, width / 4, height / 4);
    if (x >= margin && y >= margin && x <= width - margin && y <= height - margin) return;
    const box = this.stage.boundsOf(this.editing.current?.display ?? "");
    const padding = box.getSize(new Vector3()).length() / 10;
    box.expandByPoint(new Vector3().setFromMatrixPosition(this.gizmo.pose)).expandByScalar(padding);
    const bounds = boundsOf(box);
    if (bounds) this.session.view.fit(bounds, this.stage.uncoveredArea.centerView());
  }

  /** Returns the frame of a part's values, in the fixed frame; null without a transform. */
  private basePoseOf(part: EditablePart): Matrix4 | null {
    const { current } = this.editing;
    const robot = this.session.robots.get(current?.display ?? "");
    const joint = robot?.joints.find((candidate) => candidate.name === part.name);
    const link = part.part === "joint" ? joint?.parent : part.part === "axis" ? joint?.child : part.name;
    const frame = robot?.links.find((candidate) => candidate.name === link)?.frame;
    const pose = new Matrix4();
    return frame !== undefined && readFramePose(this.session.frames, this.session.frames.rowOf(frame), pose) ? pose : null;
  }

  private drag(event: ToolEvent): void {
    const { dragStart, gizmo, editing } = this;
    const { chosenPart } = editing;
    const base = chosenPart && this.basePoseOf(chosenPart);
    const steps = editing.snapping.chooseSteps(event.isCtrlDown);
    gizmo.drag(event, { length: 0, angle: steps.angle });
    if (!dragStart || !base) return;
    // Express the motion of the handles in the frame of the part's values.
    const motion = gizmo.pose.multiply(dragStart.handles.clone().invert());
    const motionInBase = base.clone().invert().multiply(motion).multiply(base);
    editing.setDraft(chosenPart.part === "axis" ? rotateAxis(dragStart.draft, motionInBase) : this.moveDraft(chosenPart, dragStart.draft, motionInBase, steps));
  }

  private moveDraft(component: EditablePart, draft: Draft, motion: Matrix4, steps: { length: number; angle: number }): Draft {
    const oldPose = createPartMatrix(component, draft);
    const newPose = motion.clone().multiply(oldPose);
    const [position, rotation] = [new Vector3(), new Quaternion()];
    newPose.decompose(position, rotation, new Vector3());
    if (this.editing.mode === "rotate") {
      const rpy = findNearestRpy([rotation.x, rotation.y, rotation.z, rotation.w], draft.rpy);
      return { xyz: draft.xyz, rpy: roundChanged(rpy, draft.rpy, steps.angle > 0 ? 0 : ANGLE_ROUNDING_RAD) };
    }
    const step = steps.length || LENGTH_ROUNDING_M;
    if (this.editing.frame === "parent") return { xyz: roundChanged(position.toArray(), draft.xyz, step), rpy: draft.rpy };
    // Along the part's own axes, round the distance to the grid rather than the position.
    const oldRotation = new Quaternion().setFromRotationMatrix(oldPose);
    const movement = position.sub(new Vector3().fromArray(draft.xyz)).applyQuaternion(oldRotation.clone().invert());
    const offset = new Vector3(...movement.toArray().map((component) => snap(component, step))).applyQuaternion(oldRotation);
    return { xyz: roundChanged(offset.toArray().map((component, i) => component + (draft.xyz[i] ?? 0)), draft.xyz, 0), rpy: draft.rpy };
  }

  private release(event: ToolEvent): void {
    this.gizmo.release(event);
    this.dragStart = null;
    this.update();
  }

  /** Draws the robot as it would be after the edit. */
  private preview(part: EditablePart | null): void {
    const { editing, stage, currentDraft } = this;
    const display = part && (editing.draft || part.part === "collision") ? (editing.current?.display ?? null) : null;
    if (this.previewedDisplay !== null && this.previewedDisplay !== display) this.findRobotDrawing(this.previewedDisplay)?.displace(null);
    this.previewedDisplay = display;
    if (display === null || !part || !currentDraft || part.part === "axis" || part.part === "inertial") {
      if (display !== null) this.findRobotDrawing(display)?.displace(null);
      stage.loop.invalidate();
      return;
    }
    const [oldPose, newPose] = [createPartMatrix(part, part), createPartMatrix(part, currentDraft)];
    if (part.part === "joint") {
      const links = this.listDescendantLinks(display, part.name);
      this.findRobotDrawing(display)?.displace({
        moveLink: (name, matrix) => {
          const base = links.has(name) ? this.basePoseOf(part) : null;
          if (base) matrix.premultiply(base.clone().multiply(newPose).multiply(oldPose.clone().invert()).multiply(base.invert()));
        },
      });
    } else {
      const twins = editing.parts.filter((candidate) => candidate.part === part.part && candidate.index < part.index && isPlacedAs(candidate, part));
      this.findRobotDrawing(display)?.displace({ movedShape: { link: part.name, kind: part.part, index: twins.length, from: oldPose, to: newPose } });
    }
    stage.loop.invalidate();
  }

  private findRobotDrawing(display: string): RobotModelDrawing | null {
    const drawing = this.stage.picker.drawingOf(display);
    return drawing instanceof RobotModelDrawing ? drawing : null;
  }

  /** Returns the links that a joint carries. */
  private listDescendantLinks(display: string, joint: string): ReadonlySet<string> {
    const joints = this.session.robots.get(display)?.joints ?? [];
    const links = new Set<string>();
    const stack = joints.filter(({ name }) => name === joint).map(({ child }) => child);
    for (let link = stack.pop(); link !== undefined; link = stack.pop()) {
      if (links.has(link)) continue;
      links.add(link);
      for (const { parent, child } of joints) if (parent === link) stack.push(child);
    }
    return links;
  }

  private showAxis(part: EditablePart, { xyz }: Draft, base: Matrix4): void {
    this.axis.visible = part.part === "axis";
    if (!this.axis.visible) return;
    const axisLength = this.stage.boundsOf(this.editing.current?.display ?? "").getSize(new Vector3()).length() / 4 || 0.2;
    const axisEnd = new Vector3().fromArray(xyz).normalize().multiplyScalar(axisLength);
    this.axis.geometry.setFromPoints([axisEnd.clone().negate().applyMatrix4(base), axisEnd.applyMatrix4(base)]);
  }
}

/** Returns the pose of a part; for an axis, the rotation from x to its direction. */
function createPartMatrix(part: EditablePart, { xyz, rpy }: Draft): Matrix4 {
  if (part.part === "axis") {
    const rotation = new Quaternion().setFromUnitVectors(new Vector3(1, 0, 0), new Vector3().fromArray(xyz).normalize());
    return new Matrix4().makeRotationFromQuaternion(rotation);
  }
  return setPoseMatrix([...xyz, ...quaternionOf(rpy)], new Matrix4());
}

function rotateAxis({ xyz }: Draft, motion: Matrix4): Draft {
  const [x, y, z] = new Vector3().fromArray(xyz).normalize().transformDirection(motion).toArray();
  return { xyz: [x, y, z].map((component) => snap(component, AXIS_ROUNDING)), rpy: [] };
}

/** Rounds numbers to a grid, and keeps those that hardly changed. */
function roundChanged(numbers: readonly number[], oldNumbers: readonly number[], step: number): number[] {
  return numbers.map((number, i) => {
    const oldNumber = oldNumbers[i] ?? 0;
    return Math.abs(number - oldNumber) < 1e-6 ? oldNumber : Number(snap(number, step).toPrecision(12));
  });
}

function isPlacedAs(first: EditablePart, second: EditablePart): boolean {
  return [...first.xyz, ...first.rpy].every((value, i) => value === [...second.xyz, ...second.rpy][i]);
}

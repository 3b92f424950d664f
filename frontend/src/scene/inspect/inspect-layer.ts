import { Box3, Group, Vector3 } from "three";
import type { Session } from "../../state/session";
import { DepthMarks } from "./depth-marks";
import type { InspectedRobot } from "./inspected-robot";
import { JointMarks } from "./joint-marks";
import { MassMarks } from "./mass-marks";

/** Marks are made with this part of the robot's diagonal. */
const UNIT = 0.2;
/** For a robot that draws nothing, m. */
const UNIT_OF_NOTHING = 0.2;

/** Draws what is invisible of the robots, as far as the user wants to see it. It costs nothing while he does not. */
export class InspectLayer {
  readonly root = new Group();
  private marks: { masses: MassMarks; joints: JointMarks; frames: DepthMarks } | null = null;
  private releases: (() => void)[] = [];
  private isMasses = false;
  private readonly units = new Map<string, { revision: number; unit: number }>();

  /** @param boundsOf the box around what a display draws, in the fixed frame. */
  constructor(
    private readonly session: Session,
    private readonly boundsOf: (display: string) => Box3,
    invalidate: () => void,
  ) {
    const { inspect, description } = session;
    inspect.changed.on(() => {
      this.holdWhatIsNeeded();
      invalidate();
    });
    // Positions may come after the transforms that they go with, which are drawn by then.
    session.joints.positionsChanged.on(() => {
      if (inspect.current.joints) invalidate();
    });
    description.arrived.on(invalidate);
    description.findingsArrived.on(invalidate);
    this.holdWhatIsNeeded();
  }

  /** Puts everything where it is now; before each frame. */
  update(): void {
    const { current, deepest, any } = this.session.inspect;
    if (!any && !this.marks) return;
    this.marks ??= {
      masses: new MassMarks(this.root),
      joints: new JointMarks(this.root),
      frames: new DepthMarks(this.root),
    };
    const robots = any ? this.robots() : [];
    this.marks.masses.update(robots, current);
    this.marks.joints.update(robots, current.joints);
    this.marks.frames.update(current.frames ? robots : null, deepest);
  }

  inspect(): object {
    const { masses, joints, frames } = this.marks ?? {};
    return { ...masses?.inspect(), ...joints?.inspect(), frames: frames?.inspect() ?? [] };
  }

  private robots(): InspectedRobot[] {
    const { displays, description, frames, joints } = this.session;
    return displays.displays.flatMap(({ id, enabled }) => {
      const model = enabled ? description.of(id) : undefined;
      if (!model) return [];
      const implausible = new Set(this.isMasses ? description.findingsOf(id).map((finding) => finding.link) : []);
      return [{ model, frames, unit: this.unitOf(id, model.description.revision), implausible, positions: joints.positions }];
    });
  }

  /** Marks keep their size while the robot moves; another description may make it another size. */
  private unitOf(display: string, revision: number): number {
    const { scale } = this.session.inspect;
    const known = this.units.get(display);
    if (known?.revision === revision) return known.unit * scale;
    const box = this.boundsOf(display);
    const unit = box.isEmpty() ? UNIT_OF_NOTHING : UNIT * box.getSize(new Vector3()).length();
    if (!box.isEmpty()) this.units.set(display, { revision, unit });
    return unit * scale;
  }

  private holdWhatIsNeeded(): void {
    const { inspect, description } = this.session;
    const { centers, boxes, ellipsoids } = inspect.current;
    this.isMasses = centers || boxes || ellipsoids;
    const before = this.releases;
    this.releases = [];
    if (inspect.any) this.releases.push(description.hold());
    if (this.isMasses) this.releases.push(description.holdFindings());
    for (const release of before) release();
  }
}

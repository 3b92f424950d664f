import { Box3, Group, Vector3 } from "three";
import type { Session } from "../../state/session";
import { DepthMarks } from "./depth-marks";
import type { InspectedRobot } from "./inspected-robot";
import { JointMarks } from "./joint-marks";
import { MassMarks } from "./mass-marks";

/** The mark size, as a share of the robot's diagonal. */
const MARK_SIZE_SHARE = 0.2;
/** The mark size for a robot without visible parts, m. */
const DEFAULT_MARK_SIZE_M = 0.2;

/** Draws those invisible properties of robots that the user wants to see. It costs nothing while there are none. */
export class InspectLayer {
  readonly root = new Group();
  private marks: { masses: MassMarks; joints: JointMarks; frames: DepthMarks } | null = null;
  private releases: (() => void)[] = [];
  private showsMasses = false;
  private readonly markSizes = new Map<string, { revision: number; markSize: number }>();

  /** @param boundsOf - returns the bounding box of a display's objects, in the fixed frame. */
  constructor(
    private readonly session: Session,
    private readonly boundsOf: (display: string) => Box3,
    invalidate: () => void,
  ) {
    const { inspect, description } = session;
    inspect.changed.on(() => {
      this.updateSubscriptions();
      invalidate();
    });
    // Positions may arrive after the transforms of the same time, which are drawn by then.
    session.joints.positionsChanged.on(() => {
      if (inspect.current.joints) invalidate();
    });
    description.arrived.on(invalidate);
    description.findingsArrived.on(invalidate);
    this.updateSubscriptions();
  }

  /** Updates all marks; called before each frame. */
  update(): void {
    const { current, maxDepth, isActive } = this.session.inspect;
    if (!isActive && !this.marks) return;
    this.marks ??= {
      masses: new MassMarks(this.root),
      joints: new JointMarks(this.root),
      frames: new DepthMarks(this.root),
    };
    const robots = isActive ? this.listRobots() : [];
    this.marks.masses.update(robots, current);
    this.marks.joints.update(robots, current.joints);
    this.marks.frames.update(current.frames ? robots : null, maxDepth);
  }

  inspect(): object {
    const { masses, joints, frames } = this.marks ?? {};
    return { ...masses?.inspect(), ...joints?.inspect(), frames: frames?.inspect() ?? [] };
  }

  private listRobots(): InspectedRobot[] {
    const { displays, description, frames, joints } = this.session;
    return displays.displays.flatMap(({ id, isEnabled }) => {
      const model = isEnabled ? description.modelOf(id) : undefined;
      if (!model) return [];
      const implausibleLinks = new Set(this.showsMasses ? description.findingsOf(id).map((finding) => finding.link) : []);
      return [{ model, frames, markSize: this.computeMarkSize(id, model.description.revision), implausibleLinks, positions: joints.positions }];
    });
  }

  /** Returns the mark size. Marks keep their size while the robot moves; a new description may change it. */
  private computeMarkSize(display: string, revision: number): number {
    const { scale } = this.session.inspect;
    const knownSize = this.markSizes.get(display);
    if (knownSize?.revision === revision) return knownSize.markSize * scale;
    const box = this.boundsOf(display);
    const markSize = box.isEmpty() ? DEFAULT_MARK_SIZE_M : MARK_SIZE_SHARE * box.getSize(new Vector3()).length();
    if (!box.isEmpty()) this.markSizes.set(display, { revision, markSize });
    return markSize * scale;
  }

  private updateSubscriptions(): void {
    const { inspect, description } = this.session;
    const { centers, boxes, ellipsoids } = inspect.current;
    this.showsMasses = centers || boxes || ellipsoids;
    const previousReleases = this.releases;
    this.releases = [];
    if (inspect.isActive) this.releases.push(description.hold());
    if (this.showsMasses) this.releases.push(description.holdFindings());
    for (const release of previousReleases) release();
  }
}

import { Signal } from "../../signal";
import type { DescriptionState } from "../description";
import type { FrameStore } from "../frames";
import type { JointsState } from "../joints";
import { composePoses, computeRelativePose, type PoseNumbers } from "../pose-numbers";
import type { SelectionState } from "../selection";
import { Chain, listBases } from "./chain";
import { solveTip, type TipSolution, type TipTask } from "./solver";

/** A drag of the tip: the chain, the base's pose at the start, and the last joint positions. */
interface Hold {
  readonly chain: Chain;
  readonly base: PoseNumbers;
  positions: readonly number[];
}

/** Dragging of the selected link, which moves the joints between it and a base. This is off until it is turned on. */
export class TipDrag {
  /** The switch, the chain or the outcome changed. */
  readonly changed = new Signal();
  /** The result of the last movement; null before the first. */
  outcome: TipSolution | null = null;
  /** The chain to the selected link; null if no joint above the link can be moved. */
  chain: Chain | null = null;
  /** The links that can be the base, from the top of the robot to the tip. */
  bases: readonly string[] = [];
  private isSwitchedOn = false;
  private chosenBase: string | null = null;
  private held: Hold | null = null;
  private releaseDescriptions: (() => void) | null = null;

  constructor(
    private readonly joints: JointsState,
    private readonly description: DescriptionState,
    private readonly selection: SelectionState,
    private readonly frames: FrameStore,
  ) {
    const onChanged = (): void => this.onChainChanged();
    for (const signal of [joints.controlsChanged, description.arrived, selection.changed]) signal.on(onChanged);
  }

  get isOn(): boolean {
    return this.isSwitchedOn;
  }

  set isOn(isOn: boolean) {
    this.isSwitchedOn = isOn;
    this.releaseDescriptions?.();
    this.releaseDescriptions = isOn ? this.description.hold() : null;
    this.onChainChanged();
  }

  /** Keeps a link in place; joints above it do not move. */
  chooseBase(link: string): void {
    this.chosenBase = link;
    this.onChainChanged();
  }

  /** The pose of the tip in the fixed frame; null without a transform. */
  get tipPose(): PoseNumbers | null {
    const { selectedLink } = this.selection;
    return selectedLink && this.poseOf(selectedLink.link.frame);
  }

  get isHeld(): boolean {
    return this.held !== null;
  }

  /** Starts a drag; returns false if there is nothing to drag. */
  hold(): boolean {
    const { chain } = this;
    const { selectedLink } = this.selection;
    const model = selectedLink && this.description.modelOf(selectedLink.display);
    const base = chain && this.poseOf(model?.links.get(chain.base)?.frame ?? "");
    if (!chain || !base) return false;
    this.held = { chain, base, positions: chain.variables.map(({ name }) => this.joints.positions[name] ?? 0) };
    return true;
  }

  /** Moves the joints so that the tip is as close as possible to a pose in the fixed frame. */
  follow(target: PoseNumbers, task: TipTask): void {
    const { held } = this;
    if (!held) return;
    this.outcome = solveTip(held.chain, held.positions, computeRelativePose(held.base, target), task);
    held.positions = this.outcome.positions;
    this.joints.move(Object.fromEntries(held.chain.variables.map(({ name }, i) => [name, held.positions[i] ?? 0])));
    this.changed.emit();
  }

  release(): void {
    this.held = null;
    this.changed.emit();
  }

  /** Moves or turns the tip by a step along its own axes. */
  step(step: PoseNumbers, task: TipTask): void {
    const { tipPose } = this;
    if (this.isHeld || !tipPose || !this.hold()) return;
    this.follow(composePoses(tipPose, step), task);
    this.release();
  }

  private poseOf(frame: string): PoseNumbers | null {
    const row = this.frames.rowOf(frame);
    return this.frames.hasPose(row) ? ([...this.frames.poses.subarray(row * 7, row * 7 + 7)] as unknown as PoseNumbers) : null;
  }

  private onChainChanged(): void {
    this.held = null;
    this.outcome = null;
    const { selectedLink } = this.selection;
    const model = this.isOn && selectedLink ? this.description.modelOf(selectedLink.display) : undefined;
    const [controls, tip] = [this.joints.controls ?? [], selectedLink?.link.name ?? ""];
    this.bases = model ? listBases(model, controls, tip) : [];
    if (this.chosenBase !== null && !this.bases.includes(this.chosenBase)) this.chosenBase = null;
    this.chain = model ? Chain.create(model, controls, tip, this.chosenBase) : null;
    this.changed.emit();
  }
}

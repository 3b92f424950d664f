import type { Connection } from "../connection/connection";
import type { AddSceneObject, AttachSceneObject, ChoosePlanner, ChooseQueryState, CommandMotion, MotionPlanningState, MoveSceneObject, RemoveSceneObject, SelectSceneObject, SetQueryJoint } from "../protocol";
import { Signal } from "../signal";
import type { DisplayDataStore } from "./display-data";
import type { DisplaysState } from "./displays";

/** The messages of the panel, to which this adds the display. */
type PanelMessage = AddSceneObject | AttachSceneObject | ChoosePlanner | ChooseQueryState | CommandMotion | MoveSceneObject | RemoveSceneObject | SelectSceneObject | SetQueryJoint;
export type PanelRequest = PanelMessage extends infer M ? (M extends PanelMessage ? Omit<M, "display"> : never) : never;

/** The state of planning of the MotionPlanning displays; the panel shows the first one that can plan. */
export class MotionPlanning {
  readonly changed = new Signal();
  /** A display that can plan appeared, or the last one disappeared. */
  readonly availabilityChanged = new Signal();
  readonly robotChanged = new Signal();
  private readonly states = new Map<string, MotionPlanningState>();
  private wasAvailable = false;
  private announcedRobot = "null";

  constructor(
    private readonly connection: Connection,
    data: DisplayDataStore,
    private readonly displays: DisplaysState,
  ) {
    data.received.on(({ display, content }) => {
      if (content.kind !== "motion_planning_state") return;
      this.states.set(display, content);
      this.announce();
    });
    data.removed.on(({ display, key }) => {
      if (key === null && this.states.delete(display)) this.announce();
    });
    displays.treeChanged.on(() => this.announce());
    displays.enabledChanged.on(() => this.announce());
  }

  /** Whether there is a display with planning groups. */
  get isAvailable(): boolean {
    return this.current !== null;
  }

  /** The state of the first enabled display with planning groups, or null. */
  get current(): MotionPlanningState | null {
    const id = this.displayId;
    return id === null ? null : (this.states.get(id) ?? null);
  }

  /** The robot of the first enabled display that draws one: its name and the number of its links; or null. */
  get robot(): { readonly name: string; readonly linkCount: number } | null {
    for (const { id, isEnabled } of this.displays.displays) {
      const state = isEnabled ? this.states.get(id) : undefined;
      if (state && state.links.length > 0) return { name: state.robot, linkCount: state.links.length };
    }
    return null;
  }

  /** The ID of that display. */
  get displayId(): string | null {
    const display = this.displays.displays.find(({ id, isEnabled }) => isEnabled && (this.states.get(id)?.group ?? "") !== "");
    return display?.id ?? null;
  }

  send(request: PanelRequest): void {
    const display = this.displayId;
    if (display !== null) this.connection.send({ ...request, display });
  }

  /** Sets a property of the display that has no row. */
  setProperty(path: string, value: boolean | number | string): void {
    const display = this.displayId;
    if (display !== null) this.connection.send({ type: "set_property", id: `${display}/${path}`, value });
  }

  private announce(): void {
    this.changed.emit();
    const robot = JSON.stringify(this.robot);
    if (robot !== this.announcedRobot) {
      this.announcedRobot = robot;
      this.robotChanged.emit();
    }
    if (this.isAvailable === this.wasAvailable) return;
    this.wasAvailable = this.isAvailable;
    this.availabilityChanged.emit();
  }
}

import type { LinkScene, RobotScene } from "../protocol.gen";
import { Signal } from "./signal";

/** A link of one RobotModel display. */
export interface SelectedLink {
  display: string;
  link: LinkScene;
}

/** The link selected in the scene and in the tree; it outlives a reload of the robot that still has it. */
export class SelectionState {
  readonly changed = new Signal<SelectedLink | null>();
  private current: SelectedLink | null = null;

  get selected(): SelectedLink | null {
    return this.current;
  }

  select(selected: SelectedLink | null): void {
    if (selected?.link === this.current?.link && selected?.display === this.current?.display) return;
    this.current = selected;
    this.changed.emit(selected);
  }

  robotChanged(robot: RobotScene): void {
    if (this.current?.display !== robot.display) return;
    const { name } = this.current.link;
    const link = robot.links.find((each) => each.name === name);
    this.select(link ? { display: robot.display, link } : null);
  }
}

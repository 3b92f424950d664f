import type { DockviewApi, DockviewGroupPanel } from "dockview";

/** Leaves out the tab of the scene in a narrow window, as long as that is alone in its place: the scene has its line. */
export class SceneTab {
  private hidden: DockviewGroupPanel | null = null;

  constructor(private readonly api: DockviewApi) {}

  /** The arrangement, or the form of the window, may be another. */
  follow(narrow: boolean): void {
    const group = this.api.getPanel("scene")?.group;
    const alone = narrow && group?.panels.length === 1 ? group : null;
    if (alone === this.hidden) return;
    if (this.hidden && this.api.groups.includes(this.hidden)) this.hidden.header.hidden = false;
    this.hidden = alone;
    if (alone) alone.header.hidden = true;
  }
}

import type { DockviewApi, DockviewGroupPanel } from "dockview";

/** Hides the tab of the scene in a narrow window while it is alone in its group; the scene's toolbar remains. */
export class SceneTab {
  private hidden: DockviewGroupPanel | null = null;

  constructor(private readonly api: DockviewApi) {}

  /** Updates the tab after the arrangement or the form of the window may have changed. */
  update(narrow: boolean): void {
    const group = this.api.getPanel("scene")?.group;
    const alone = narrow && group?.panels.length === 1 ? group : null;
    if (alone === this.hidden) return;
    if (this.hidden && this.api.groups.includes(this.hidden)) this.hidden.header.hidden = false;
    this.hidden = alone;
    if (alone) alone.header.hidden = true;
  }
}

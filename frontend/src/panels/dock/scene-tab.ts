import type { DockviewApi, DockviewGroupPanel } from "dockview";

/** Hides the tab of the scene in a narrow window while it is alone in its group; the scene's toolbar remains. */
export class SceneTab {
  private hiddenGroup: DockviewGroupPanel | null = null;

  constructor(private readonly api: DockviewApi) {}

  /** Updates the tab after the arrangement or the form of the window may have changed. */
  update(isNarrow: boolean): void {
    const group = this.api.getPanel("scene")?.group;
    const loneGroup = isNarrow && group?.panels.length === 1 ? group : null;
    if (loneGroup === this.hiddenGroup) return;
    if (this.hiddenGroup && this.api.groups.includes(this.hiddenGroup)) this.hiddenGroup.header.hidden = false;
    this.hiddenGroup = loneGroup;
    if (loneGroup) loneGroup.header.hidden = true;
  }
}

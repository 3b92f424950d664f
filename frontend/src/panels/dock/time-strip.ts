import type { DockviewApi, DockviewGroupPanel } from "dockview";
import { Signal } from "../../signal";
import type { TextStorage } from "../../storage";
import { TIME_HEIGHT_PX } from "./default-layout";

/** Pixels: the dock's default for groups. */
const MIN_GROUP_HEIGHT_PX = 100;
const STORAGE_KEY = "linkwright.time-fields";

/**
 * Shows the Time panel as a strip of one line without a tab while it is alone in its group; the strip is hidden until
 * the user unfolds it.
 */
export class TimeStrip {
  /** The strip appeared, disappeared, or was folded or unfolded. */
  readonly changed = new Signal();
  private strip: DockviewGroupPanel | null = null;
  private isOpen: boolean;

  constructor(
    private readonly api: DockviewApi,
    private readonly storage: TextStorage,
  ) {
    this.isOpen = storage.getItem(STORAGE_KEY) === "shown";
  }

  /** Whether there is a strip, folded or not. */
  get exists(): boolean {
    return this.strip !== null;
  }

  get isUnfolded(): boolean {
    return this.isOpen;
  }

  /** Shows or hides the strip. */
  setUnfolded(isUnfolded: boolean): void {
    this.isOpen = isUnfolded;
    this.storage.setItem(STORAGE_KEY, isUnfolded ? "shown" : "hidden");
    this.applyVisibility();
    this.changed.emit();
  }

  /** Updates the strip after the arrangement may have changed. */
  update(): void {
    const group = this.api.getPanel("time")?.group;
    const strip = group?.panels.length === 1 ? group : null;
    if (strip === this.strip) return;
    // A group that now has several tabs needs its tab bar and its usual height again.
    if (this.strip && this.api.groups.includes(this.strip)) {
      this.strip.api.setVisible(true);
      this.strip.header.hidden = false;
      this.strip.element.classList.remove("strip");
      this.strip.api.setConstraints({ minimumHeight: MIN_GROUP_HEIGHT_PX, maximumHeight: Number.MAX_SAFE_INTEGER });
    }
    this.strip = strip;
    if (strip) {
      strip.header.hidden = true;
      strip.element.classList.add("strip");
      strip.api.setConstraints({ minimumHeight: TIME_HEIGHT_PX, maximumHeight: TIME_HEIGHT_PX });
      this.applyVisibility();
    }
    this.changed.emit();
  }

  private applyVisibility(): void {
    const { strip } = this;
    if (!strip) return;
    if (strip.api.isVisible !== this.isOpen) strip.api.setVisible(this.isOpen);
    if (this.isOpen) strip.api.setSize({ height: TIME_HEIGHT_PX });
  }
}

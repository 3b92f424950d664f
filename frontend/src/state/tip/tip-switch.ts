import { Signal } from "../../signal";
import type { DescriptionState } from "../description";
import type { FrameStore } from "../frames";
import type { JointsState } from "../joints";
import type { SelectionState } from "../selection";
import type { TipDrag } from "./tip-drag";

/** The switch for dragging the selected link with its chain. The code for it is loaded when it is first turned on. */
export class TipSwitch {
  /** The switch was turned, or the code has been loaded. */
  readonly changed = new Signal();
  /** The dragging; null before the code is loaded. */
  drag: TipDrag | null = null;
  private isSwitchedOn = false;

  constructor(
    private readonly joints: JointsState,
    private readonly description: DescriptionState,
    private readonly selection: SelectionState,
    private readonly frames: FrameStore,
  ) {}

  get isOn(): boolean {
    return this.isSwitchedOn;
  }

  set isOn(isOn: boolean) {
    this.isSwitchedOn = isOn;
    if (this.drag) this.drag.isOn = isOn;
    else if (isOn) void this.load();
    this.changed.emit();
  }

  private async load(): Promise<void> {
    const { TipDrag } = await import("./tip-drag");
    this.drag ??= new TipDrag(this.joints, this.description, this.selection, this.frames);
    this.drag.isOn = this.isSwitchedOn;
    this.changed.emit();
  }
}

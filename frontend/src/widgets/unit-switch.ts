import { createButton, h } from "../dom";
import type { AngleUnit, AngleUnits } from "../state/angle-unit";
import { strings } from "../strings";

/** The switch between radians and degrees for all panels that show angles. */
export class UnitSwitch {
  readonly element = h("div", {
    class: "segmented",
    title: strings.joints.unitHint,
    role: "group",
    aria: { label: strings.joints.unitHint },
  });

  constructor(private readonly angles: AngleUnits) {
    angles.changed.on(() => this.show());
    this.show();
  }

  private show(): void {
    const texts = strings.joints;
    this.element.replaceChildren(this.createChoice("rad", texts.radians), this.createChoice("deg", texts.degrees));
  }

  private createChoice(unit: AngleUnit, label: string): HTMLElement {
    const isCurrent = unit === this.angles.current;
    const element = createButton(label, () => (this.angles.current = unit), isCurrent ? "on" : "", label);
    element.setAttribute("aria-pressed", String(isCurrent));
    return element;
  }
}

import { createButton, coalesce, h } from "../../dom";
import { createIcon, type IconName } from "../../icons";
import type { ComparedItem, ComparedLocation } from "../../protocol";
import { groupDifferences, MARK_COLORS, listUsedMarks, type DifferenceGroup } from "../../state/comparison";
import type { DisplayState } from "../../state/displays";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { createTickBox } from "../../widgets/controls";
import type { Panel } from "../panel";
import { shortenPlace } from "../place";

const KIND_ICONS = { added: "plus", removed: "minus", renamed: "rename", changed: "options" } as const satisfies Record<string, IconName>;
const SUBJECT_ICONS = { robot: "diagram", link: "cube", joint: "joints", extension: "code" } as const satisfies Record<string, IconName>;

/** The differences of two descriptions, and switches for drawing each of the two. */
export class ComparisonPanel implements Panel {
  readonly id = "comparison";
  readonly icon = "compare";
  readonly element: HTMLElement;
  private readonly oldSwitch = this.createSwitch("old", strings.comparison.old, strings.comparison.showOld);
  private readonly newSwitch = this.createSwitch("new", strings.comparison.new, strings.comparison.showNew);
  private readonly alpha = h("input", { class: "slider", title: strings.comparison.alpha, aria: { label: strings.comparison.alpha } });
  private readonly marks = createTickBox(strings.comparison.marks, strings.comparison.marksHint, (isTicked) => (this.session.comparison.areMarksShown = isTicked));
  private readonly legend = h("ul", { class: "comparison-legend" });
  private readonly countText = h("p", { class: "comparison-count", role: "status" });
  private readonly list = h("div", { class: "comparison-list", role: "list", aria: { label: strings.comparison.list } });

  /** @param focusScene - points the camera at the selection. */
  constructor(
    private readonly session: Session,
    private readonly focusScene: () => void,
  ) {
    this.alpha.type = "range";
    [this.alpha.min, this.alpha.max, this.alpha.step] = ["0", "1", "0.05"];
    this.alpha.style.setProperty("--zero", "0");
    this.alpha.addEventListener("input", () => {
      const row = this.displayOf("old")?.rows.find("Alpha");
      if (row) session.setProperty(row.id, Number(this.alpha.value));
      this.showSwitches();
    });
    const head = h(
      "div",
      { class: "comparison-head" },
      h("div", { class: "comparison-row" }, this.newSwitch),
      h("div", { class: "comparison-row" }, this.oldSwitch, this.alpha),
      h("div", { class: "comparison-row" }, this.marks),
      this.legend,
    );
    const body = h("div", { class: "comparison-body" }, h("div", { class: "comparison-top" }, head, this.countText), this.list);
    this.element = h("div", { class: "panel comparison" }, body);
    this.list.addEventListener("pointerleave", () => session.focus.setHovered(null));
    const { comparison, displays } = session;
    const updateSwitches = coalesce(() => this.showSwitches());
    comparison.changed.on(() => this.show());
    displays.treeChanged.on(updateSwitches);
    displays.enabledChanged.on(updateSwitches);
    displays.valueChanged.on(({ display }) => {
      if (display) updateSwitches();
    });
    session.focus.changed.on(coalesce(() => this.showFocus()));
    this.show();
  }

  private createSwitch(side: "old" | "new", text: string, hint: string): ReturnType<typeof createTickBox> {
    const tickBox = createTickBox(text, hint, (isTicked) => {
      const display = this.displayOf(side);
      if (display) this.session.setProperty(display.enabledId, isTicked);
    });
    tickBox.append(h("span", { class: "comparison-file" }));
    return tickBox;
  }

  private displayOf(side: "old" | "new"): DisplayState | undefined {
    return this.session.displays.find(this.session.comparison.compared?.[side].display ?? "");
  }

  private show(): void {
    const { compared } = this.session.comparison;
    if (!compared) return;
    const texts = strings.comparison;
    for (const [tickBox, { label }] of [[this.oldSwitch, compared.old], [this.newSwitch, compared.new]] as const) {
      const file = tickBox.querySelector(".comparison-file");
      if (file) file.textContent = shortenPlace(label);
      tickBox.title = `${tickBox === this.oldSwitch ? texts.showOld : texts.showNew}\n${label}`;
    }
    const marks = listUsedMarks([compared.new, compared.old]);
    this.legend.replaceChildren(
      ...marks.map((mark) => {
        const swatch = h("span", { class: "comparison-swatch" });
        swatch.style.background = MARK_COLORS[mark];
        return h("li", { data: { mark } }, swatch, texts.mark[mark]);
      }),
    );
    const { items } = compared;
    this.element.classList.toggle("same", items.length === 0);
    this.countText.textContent = items.length === 0 ? texts.same : texts.count(items.length);
    const scrollTop = this.list.scrollTop;
    this.list.replaceChildren(...groupDifferences(items).map((group) => this.createGroup(group)));
    this.list.scrollTop = scrollTop;
    this.showSwitches();
    this.showFocus();
  }

  private showSwitches(): void {
    for (const [tickBox, side] of [[this.oldSwitch, "old"], [this.newSwitch, "new"]] as const) {
      const display = this.displayOf(side);
      tickBox.box.disabled = display === undefined;
      tickBox.box.checked = display?.isEnabled ?? false;
    }
    const alpha = this.displayOf("old")?.rows.number(1, "Alpha") ?? 1;
    this.alpha.disabled = !this.oldSwitch.box.checked;
    this.alpha.value = String(alpha);
    this.alpha.style.setProperty("--part", String(alpha));
    this.marks.box.checked = this.session.comparison.areMarksShown;
  }

  /** Marks the group of the selected element. */
  private showFocus(): void {
    const { current } = this.session.focus;
    const key = current ? createElementKey(current) : "";
    for (const group of this.list.querySelectorAll<HTMLElement>(".difference-group")) {
      const isSelected = group.dataset["element"] === key;
      group.classList.toggle("selected", isSelected);
      if (isSelected) group.scrollIntoView({ block: "nearest" });
    }
  }

  private createGroup({ items, kind }: DifferenceGroup): HTMLElement {
    const [first] = items;
    if (!first) return h("div");
    const texts = strings.comparison;
    const { focus, comparison } = this.session;
    const element = comparison.elementOf(first);
    const label = [createIcon(SUBJECT_ICONS[first.subject]), h("span", { class: "difference-kind" }, texts.subjects[first.subject]), first.name] as const;
    const select = (): void => {
      focus.select(element);
      this.focusScene();
    };
    const header = element
      ? createButton(texts.select(first.name), select, "difference-name", ...label)
      : h("div", { class: "difference-name" }, ...label);
    const group = h(
      "div",
      { class: "difference-group", role: "listitem", data: element ? { element: createElementKey(element) } : {} },
      h("div", { class: "difference-head" }, header, items.length === 1 && first.property === "" ? createKindTag(kind) : null),
      ...items.map((item) => this.createItem(item, select)),
    );
    const highlight = (): void => focus.setHovered(element);
    group.addEventListener("pointerenter", highlight);
    group.addEventListener("focusin", highlight);
    group.addEventListener("focusout", () => focus.setHovered(null));
    return group;
  }

  private createItem(item: ComparedItem, select: () => void): HTMLElement {
    const texts = strings.comparison;
    const formatValue = (text: string | null): string => text ?? texts.nothing;
    const valueLine =
      item.property === ""
        ? null
        : h(
            "div",
            { class: "difference-values" },
            createIcon(KIND_ICONS[item.kind]),
            h("span", { class: "difference-property" }, item.property),
            h("span", { class: "difference-value" }, h("del", {}, formatValue(item.old)), " → ", h("ins", {}, [formatValue(item.new), item.unit].filter((part) => part !== "").join(" "))),
          );
    valueLine?.addEventListener("click", select);
    const locations = [this.createLocation(item.old_place, "old"), this.createLocation(item.new_place, "new")].filter((element) => element !== null);
    return h("div", { class: "difference" }, valueLine, locations.length > 0 ? h("div", { class: "difference-places" }, ...locations) : null);
  }

  /** Returns the place in the text: a link into the Source panel if that can show it. */
  private createLocation(place: ComparedLocation | null, side: "old" | "new"): HTMLElement | null {
    if (!place) return null;
    const { text, file, line } = place;
    const parts = [h("span", { class: "difference-side" }, strings.comparison[side]), shortenPlace(text)] as const;
    const display = this.session.comparison.compared?.[side].display ?? "";
    if (file === "" || display === "") return h("span", { class: "place", title: text }, ...parts);
    const name = text.replace(/(:\d+)+$/, "");
    return createButton(text, () => this.session.description.placeRequested.emit({ file, line, display, name }), "place", ...parts);
  }
}

function createKindTag(kind: ComparedItem["kind"]): HTMLElement {
  return h("span", { class: `difference-tag ${kind}` }, createIcon(KIND_ICONS[kind]), strings.comparison.kinds[kind]);
}

function createElementKey({ display, kind, name }: { display: string; kind: string; name: string }): string {
  return [display, kind, name].join(" ");
}

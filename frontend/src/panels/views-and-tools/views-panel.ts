import { button, h } from "../../dom";
import { icon } from "../../icons";
import type { Property, PropertyValue } from "../../protocol";
import type { Session } from "../../state/session";
import { FIXED_FRAME, type ViewState } from "../../state/view";
import { shortName } from "../../state/views/catalog";
import type { ViewValues } from "../../state/views/view-controller";
import { strings } from "../../strings";
import { formatPoint } from "../../tree/numbers";
import type { TreeItem } from "../../tree/tree-item";
import { TreeView } from "../../tree/tree-view";
import type { Panel } from "../panel";

const CURRENT = "current";

/** RViz's Views panel: the current view and the saved ones. */
export class ViewsPanel implements Panel {
  readonly id = "views";
  readonly icon = "camera";
  readonly element: HTMLElement;
  private readonly view: ViewState;
  private readonly type = h("select", { class: "choice", aria: { label: strings.views.type } });
  private readonly name = h("input", { class: "field", aria: { label: strings.views.newName } });
  private readonly remove: HTMLButtonElement;
  private readonly rename: HTMLButtonElement;
  /** The saved view whose row, or a row below it, is selected. */
  private chosen: string | null = null;

  constructor({ view, frames }: Session) {
    this.view = view;
    const texts = strings.views;
    const tree = new TreeView(
      strings.panels.views,
      () => this.items(),
      () => [FIXED_FRAME, ...frames.names],
    );
    const zero = button(texts.zeroHint, () => view.zero(), "tool", icon("zero"), h("span", { class: "tool-name" }, texts.zero));
    zero.setAttribute("aria-label", texts.zero);
    this.remove = button(texts.removeHint, () => this.removeChosen(), "tool", texts.remove);
    this.rename = button(texts.renameHint, () => this.startRename(), "tool", texts.rename);
    this.type.addEventListener("change", () => view.setClass(this.type.value));
    this.name.addEventListener("keydown", (event) => this.onNameKey(event));
    this.name.addEventListener("blur", () => {
      this.name.hidden = true;
    });
    this.name.hidden = true;
    this.element = h(
      "div",
      { class: "panel views-panel" },
      h(
        "div",
        { class: "toolbar" },
        h("label", { class: "view-type" }, h("span", { class: "toolbar-label" }, texts.type), this.type),
        zero,
        button(texts.resetHint, () => view.reset(), "tool bare", icon("reset")),
      ),
      tree.element,
      h(
        "div",
        { class: "toolbar bottom" },
        button(texts.saveHint, () => view.save(shortName(view.current.cls)), "tool", texts.save),
        this.remove,
        this.rename,
        this.name,
      ),
    );
    tree.element.addEventListener("keydown", (event) => this.onKeyDown(event), true);
    tree.selected.on((item) => {
      const [owner] = item.key.split("|");
      this.chosen = owner === CURRENT ? null : (owner ?? null);
      this.update();
    });
    view.changed.on(() => {
      this.update();
      tree.refresh();
    });
    view.listsChanged.on(() => {
      if (!view.savedViews.some((each) => each.id === this.chosen)) this.chosen = null;
      this.update();
      tree.refresh();
    });
    this.update();
  }

  private update(): void {
    const { classes, current } = this.view;
    if (this.type.options.length !== classes.length) {
      this.type.replaceChildren(...classes.map(({ cls }) => new Option(shortName(cls), cls)));
    }
    this.type.value = current.cls;
    this.remove.disabled = this.rename.disabled = this.chosen === null;
  }

  private items(): TreeItem[] {
    const { view } = this;
    const { current } = view;
    const set = (path: string, value: PropertyValue): void => view.set(path, value);
    return [
      {
        key: CURRENT,
        name: strings.views.current,
        kind: "group",
        value: shortName(current.cls),
        description: "",
        strong: true,
        expanded: true,
        children: () => rows(CURRENT, view.properties, current.values, set),
      },
      ...view.savedViews.map(({ id, view: saved }): TreeItem => ({
        key: id,
        name: saved.name,
        kind: "group",
        value: shortName(saved.cls),
        description: strings.views.useHint,
        activate: () => view.use(id),
        children: () =>
          rows(id, view.propertiesOf(saved.cls), saved.values, (path, value) => view.setSaved(id, path, value)),
      })),
    ];
  }

  private onKeyDown(event: KeyboardEvent): void {
    if (!(event.target as HTMLElement).matches("[role=treeitem]") || this.chosen === null) return;
    if (event.key === "Delete") this.removeChosen();
    else if (event.key === "F2" && (event.target as HTMLElement).dataset["key"] === this.chosen) this.startRename();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  private removeChosen(): void {
    if (this.chosen !== null) this.view.remove(this.chosen);
  }

  private startRename(): void {
    const saved = this.view.savedViews.find((each) => each.id === this.chosen);
    if (!saved) return;
    this.name.hidden = false;
    this.name.value = saved.view.name;
    this.name.focus();
    this.name.select();
  }

  private onNameKey(event: KeyboardEvent): void {
    if (event.key === "Enter" && this.chosen !== null) this.view.rename(this.chosen, this.name.value);
    if (event.key === "Enter" || event.key === "Escape") this.name.hidden = true;
    event.stopPropagation();
  }
}

/** Returns the rows of a view; their keys begin with the key of the view. */
function rows(
  owner: string,
  properties: readonly Property[],
  values: ViewValues,
  set: (path: string, value: PropertyValue) => void,
): TreeItem[] {
  return properties.map((property): TreeItem => {
    const { id, name, kind, description, minimum, maximum, children } = property;
    const isGroup = kind === "group";
    return {
      key: `${owner}|${id}`,
      name,
      kind,
      value: isGroup ? summary(children, values) : (values[id] ?? property.value),
      description,
      minimum,
      maximum,
      ...(children.length > 0 ? { children: () => rows(owner, children, values, set) } : {}),
      ...(isGroup ? {} : { set: (value: PropertyValue) => set(id, value) }),
    };
  });
}

/** Returns `1; 2; 3` for a point. */
function summary(children: readonly Property[], values: ViewValues): string {
  return formatPoint(children.map(({ id, value }) => Number(values[id] ?? value)));
}

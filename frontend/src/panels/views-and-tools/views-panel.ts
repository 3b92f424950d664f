import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import type { Property, PropertyValue } from "../../protocol";
import type { Session } from "../../state/session";
import { FIXED_FRAME, type ViewState } from "../../state/view";
import { shortNameOf } from "../../state/views/catalog";
import type { ViewValues } from "../../state/views/view-controller";
import { strings } from "../../strings";
import { formatPoint } from "../../tree/numbers";
import type { TreeItem } from "../../tree/tree-item";
import { TreeView } from "../../tree/tree-view";
import type { Panel } from "../panel";

const CURRENT_VIEW_KEY = "current";

/** RViz's Views panel: the current view and the saved ones. */
export class ViewsPanel implements Panel {
  readonly id = "views";
  readonly icon = "camera";
  readonly element: HTMLElement;
  private readonly view: ViewState;
  private readonly typeSelect = h("select", { class: "choice", aria: { label: strings.views.type } });
  private readonly nameField = h("input", { class: "field", aria: { label: strings.views.newName } });
  private readonly removeButton: HTMLButtonElement;
  private readonly renameButton: HTMLButtonElement;
  /** The saved view whose row, or a row below it, is selected. */
  private selectedId: string | null = null;

  constructor({ view, frames }: Session) {
    this.view = view;
    const texts = strings.views;
    const tree = new TreeView(
      strings.panels.views,
      () => this.createItems(),
      () => [FIXED_FRAME, ...frames.names],
    );
    const zeroButton = createButton(texts.zeroHint, () => view.zero(), "tool", createIcon("zero"), h("span", { class: "tool-name" }, texts.zero));
    zeroButton.setAttribute("aria-label", texts.zero);
    this.removeButton = createButton(texts.removeHint, () => this.removeChosen(), "tool", texts.remove);
    this.renameButton = createButton(texts.renameHint, () => this.startRename(), "tool", texts.rename);
    this.typeSelect.addEventListener("change", () => view.setClass(this.typeSelect.value));
    this.nameField.addEventListener("keydown", (event) => this.onNameKey(event));
    this.nameField.addEventListener("blur", () => {
      this.nameField.hidden = true;
    });
    this.nameField.hidden = true;
    this.element = h(
      "div",
      { class: "panel views-panel" },
      h(
        "div",
        { class: "toolbar" },
        h("label", { class: "view-type" }, h("span", { class: "toolbar-label" }, texts.type), this.typeSelect),
        zeroButton,
        createButton(texts.resetHint, () => view.reset(), "tool bare", createIcon("reset")),
      ),
      tree.element,
      h(
        "div",
        { class: "toolbar bottom" },
        createButton(texts.saveHint, () => view.save(shortNameOf(view.current.cls)), "tool", texts.save),
        this.removeButton,
        this.renameButton,
        this.nameField,
      ),
    );
    tree.element.addEventListener("keydown", (event) => this.onKeyDown(event), true);
    tree.itemSelected.on((item) => {
      const [viewKey] = item.key.split("|");
      this.selectedId = viewKey === CURRENT_VIEW_KEY ? null : (viewKey ?? null);
      this.update();
    });
    view.changed.on(() => {
      this.update();
      tree.refresh();
    });
    view.listsChanged.on(() => {
      if (!view.savedViews.some((savedView) => savedView.id === this.selectedId)) this.selectedId = null;
      this.update();
      tree.refresh();
    });
    this.update();
  }

  private update(): void {
    const { classes, current } = this.view;
    if (this.typeSelect.options.length !== classes.length) {
      this.typeSelect.replaceChildren(...classes.map(({ cls }) => new Option(shortNameOf(cls), cls)));
    }
    this.typeSelect.value = current.cls;
    this.removeButton.disabled = this.renameButton.disabled = this.selectedId === null;
  }

  private createItems(): TreeItem[] {
    const { view } = this;
    const { current } = view;
    const set = (path: string, value: PropertyValue): void => view.setProperty(path, value);
    return [
      {
        key: CURRENT_VIEW_KEY,
        name: strings.views.current,
        kind: "group",
        value: shortNameOf(current.cls),
        description: "",
        isStrong: true,
        isExpanded: true,
        children: () => createRows(CURRENT_VIEW_KEY, view.properties, current.values, set),
      },
      ...view.savedViews.map(({ id, view: savedView }): TreeItem => ({
        key: id,
        name: savedView.name,
        kind: "group",
        value: shortNameOf(savedView.cls),
        description: strings.views.useHint,
        activate: () => view.applySaved(id),
        children: () =>
          createRows(id, view.propertiesOf(savedView.cls), savedView.values, (path, value) => view.setSavedValue(id, path, value)),
      })),
    ];
  }

  private onKeyDown(event: KeyboardEvent): void {
    if (!(event.target as HTMLElement).matches("[role=treeitem]") || this.selectedId === null) return;
    if (event.key === "Delete") this.removeChosen();
    else if (event.key === "F2" && (event.target as HTMLElement).dataset["key"] === this.selectedId) this.startRename();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  private removeChosen(): void {
    if (this.selectedId !== null) this.view.remove(this.selectedId);
  }

  private startRename(): void {
    const chosenView = this.view.savedViews.find((savedView) => savedView.id === this.selectedId);
    if (!chosenView) return;
    this.nameField.hidden = false;
    this.nameField.value = chosenView.view.name;
    this.nameField.focus();
    this.nameField.select();
  }

  private onNameKey(event: KeyboardEvent): void {
    if (event.key === "Enter" && this.selectedId !== null) this.view.rename(this.selectedId, this.nameField.value);
    if (event.key === "Enter" || event.key === "Escape") this.nameField.hidden = true;
    event.stopPropagation();
  }
}

/** Returns the rows of a view; their keys begin with the key of the view. */
function createRows(
  viewKey: string,
  properties: readonly Property[],
  values: ViewValues,
  set: (path: string, value: PropertyValue) => void,
): TreeItem[] {
  return properties.map((property): TreeItem => {
    const { id, name, kind, description, minimum, maximum, children } = property;
    const isGroup = kind === "group";
    return {
      key: `${viewKey}|${id}`,
      name,
      kind,
      value: isGroup ? formatSummary(children, values) : (values[id] ?? property.value),
      description,
      minimum,
      maximum,
      ...(children.length > 0 ? { children: () => createRows(viewKey, children, values, set) } : {}),
      ...(isGroup ? {} : { set: (value: PropertyValue) => set(id, value) }),
    };
  });
}

/** Returns `1; 2; 3` for a point. */
function formatSummary(children: readonly Property[], values: ViewValues): string {
  return formatPoint(children.map(({ id, value }) => Number(values[id] ?? value)));
}

import { createButton, h } from "../../dom";
import { createIcon, LEVEL_ICONS } from "../../icons";
import type { StatusRow } from "../../protocol";
import type { DisplayState } from "../../state/displays";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { filterItems } from "../../tree/filter-items";
import { TreeView } from "../../tree/tree-view";
import { openMenuAt } from "../../widgets/menu";
import { formatShortcut, SHORTCUTS } from "../../widgets/shortcuts";
import type { Panel } from "../panel";
import { DisplayCommands } from "./display-commands";
import { DisplayDrag } from "./display-drag";
import { describeDisplay, createDisplayItems, formatStatusRow } from "./display-items";
import { followLiveValues } from "./live-values";
import { isExpansion, findLinkOfRow, findLinkRowPath } from "./robot-rows";

/** RViz's Displays panel: a toolbar, the property tree, and the description of the selected row. */
export class DisplaysPanel implements Panel {
  readonly id = "displays";
  readonly icon = "displays";
  readonly element: HTMLElement;
  private readonly tree: TreeView;
  private readonly commands: DisplayCommands;
  private readonly filter = h("input", { class: "field" });
  private readonly emptyNote = h("p", { class: "empty" }, strings.displays.nothingFound);
  /** Hidden until a row is selected. */
  private readonly helpBox = h("div", { class: "help", aria: { live: "polite" } });
  private explainedKey = "";
  private readonly displayButtons: HTMLButtonElement[] = [];

  constructor(private readonly session: Session) {
    this.tree = new TreeView(strings.panels.displays, () => this.listItems(), () => session.frames.names);
    this.tree.preserveIn(session.pageMemory, this.id);
    this.commands = new DisplayCommands(session, () => this.selectedDisplay, () => this.selectedDisplays);
    this.emptyNote.hidden = this.helpBox.hidden = true;
    this.element = h("div", { class: "panel displays-panel" }, this.createToolbar(), this.createFilterBar(), this.emptyNote, this.tree.element, this.helpBox);
    this.listen();
    this.bindKeysAndMouse();
    this.updateButtons();
  }

  /** The display to which the selected row belongs. */
  private get selectedDisplay(): DisplayState | null {
    return this.displayOf(this.tree.selection);
  }

  /** The displays of all selected rows. */
  private get selectedDisplays(): DisplayState[] {
    const displays = this.tree.selections.flatMap((key) => this.displayOf(key) ?? []);
    return [...new Set(displays)];
  }

  private createToolbar(): HTMLElement {
    const texts = strings.displays;
    const { commands } = this;
    const createTool = (label: string, name: Parameters<typeof createIcon>[0], keys: string, run: () => void): HTMLButtonElement => {
      const toolButton = createButton(`${label} (${keys})`, run, "tool bare", createIcon(name));
      this.displayButtons.push(toolButton);
      return toolButton;
    };
    return h(
      "div",
      { class: "toolbar", role: "toolbar", aria: { label: strings.panels.displays } },
      createButton(`${texts.addHint} (${formatShortcut(SHORTCUTS.add)})`, () => commands.add(), "tool", createIcon("add"), texts.add),
      createTool(texts.duplicate, "duplicate", formatShortcut(SHORTCUTS.duplicate), () => commands.duplicate()),
      createTool(texts.rename, "rename", formatShortcut(SHORTCUTS.rename), () => commands.rename()),
      createTool(texts.remove, "remove", formatShortcut(SHORTCUTS.remove), () => commands.remove()),
    );
  }

  private createFilterBar(): HTMLElement {
    this.filter.type = "search";
    this.filter.placeholder = strings.displays.filter;
    this.filter.setAttribute("aria-label", strings.displays.filter);
    this.filter.addEventListener("input", () => this.tree.refresh());
    this.filter.addEventListener("keydown", (event) => {
      if (event.key !== "Escape" || this.filter.value === "") return;
      this.filter.value = "";
      this.tree.refresh();
      event.stopPropagation();
    });
    return h("div", { class: "search-box" }, createIcon("search"), this.filter);
  }

  private listItems(): ReturnType<typeof filterItems> {
    const items = filterItems(createDisplayItems(this.session), this.filter.value);
    this.emptyNote.hidden = items.length > 0;
    return items;
  }

  private listen(): void {
    const { displays, selection, frames } = this.session;
    for (const signal of [displays.treeChanged, displays.rowsChanged, displays.valueChanged]) {
      (signal as { on(listener: () => void): void }).on(this.tree.refresh);
    }
    displays.valueChanged.on(({ node, display }) => {
      if (!display || !isExpansion(node)) return;
      const prefixes = [`${display.id}/Links/`, `${display.id}/Joints/`];
      this.tree.resetExpansion((key) => prefixes.some((prefix) => key.startsWith(prefix)));
    });
    displays.statusChanged.on(this.tree.refresh);
    displays.statusChanged.on((display) => {
      if (display && this.tree.selection === display.id) this.explainDisplay(display);
    });
    displays.rowRequested.on((display) => {
      this.filter.value = "";
      this.tree.reveal(findPath(display));
      this.explainDisplay(display);
      this.updateButtons();
    });
    displays.enabledChanged.on(this.tree.refresh);
    displays.treeChanged.on(() => {
      this.updateButtons();
      const { selectedDisplay } = this;
      if (selectedDisplay && this.tree.selection === selectedDisplay.id) this.explainDisplay(selectedDisplay);
    });
    frames.tableChanged.on(this.tree.refresh);
    followLiveValues(this.tree, this.session);
    this.tree.itemSelected.on((item) => {
      const display = this.session.displays.find(item.key);
      if (display) this.explainDisplay(display);
      else this.explain(item.name, item.description);
      this.selectLink(item.key);
      this.updateButtons();
    });
    selection.changed.on(() => this.showSelection());
  }

  private bindKeysAndMouse(): void {
    const { tree, commands, session } = this;
    tree.element.addEventListener(
      "keydown",
      (event) => {
        const isOnRow = event.target instanceof Element && event.target.matches("[role=treeitem], .check");
        const isOnDisplay = tree.selections.length > 0 && tree.selections.every((key) => session.displays.find(key));
        if (!isOnRow || !commands.handleKey(event, isOnDisplay)) return;
        event.preventDefault();
        event.stopPropagation();
      },
      true,
    );
    tree.element.addEventListener("contextmenu", (event) => {
      const item = tree.itemAt(event.target);
      const display = this.displayOf(item?.item.key ?? null);
      if (!item || !display || (event.target instanceof Element && event.target.matches("input[type=text]"))) return;
      event.preventDefault();
      if (!tree.selections.includes(item.item.key)) item.element.focus();
      const texts = strings.displays;
      const box = item.element.getBoundingClientRect();
      const [x, y] = event.clientX === 0 && event.clientY === 0 ? [box.left + 24, box.bottom] : [event.clientX, event.clientY];
      openMenuAt(x, y, item.element, [
        ...commands.createMenu(display),
        { label: texts.expandAll, icon: "expand", hasLineAbove: true, run: () => tree.expandAll(item.item, true) },
        { label: texts.collapseAll, icon: "collapse", run: () => tree.expandAll(item.item, false) },
      ]);
    });
    new DisplayDrag({
      element: tree.element,
      displayAt: (target) => {
        const item = tree.itemAt(target);
        const display = this.displayOf(item?.item.key ?? null);
        return item && display && { display, row: item.item.key === display.id ? item.element : null };
      },
      listDisplays: () => session.displays.displays,
      move: (display, { group, nextSibling }) => session.configuration.move([display.id], group, nextSibling),
    });
  }

  private displayOf(key: string | null): DisplayState | null {
    const id = key?.split(/[/#]/, 1)[0];
    return (id !== undefined && this.session.displays.find(id)) || null;
  }

  private updateButtons(): void {
    const hasNoSelection = this.selectedDisplay === null;
    for (const control of this.displayButtons) control.disabled = hasNoSelection;
  }

  private explain(name: string, description: string, statusRows: readonly StatusRow[] = []): void {
    const key = JSON.stringify([name, description, statusRows]);
    if (key === this.explainedKey) return; // do not announce the text again with each message
    this.explainedKey = key;
    this.tree.runAfterRelease(() => {
      if (key !== this.explainedKey) return;
      this.helpBox.hidden = description === "" && statusRows.length === 0;
      const problems = statusRows.map((row) => h("p", { class: `trouble ${row.level}` }, createIcon(LEVEL_ICONS[row.level], `level-${row.level}`), formatStatusRow(row)));
      this.helpBox.replaceChildren(h("strong", {}, name), ...problems, h("p", {}, description));
    });
  }

  /** Shows the problems of a display, followed by its description. */
  private explainDisplay(display: DisplayState): void {
    this.explain(display.name, describeDisplay(display), display.problems);
  }

  private selectLink(key: string): void {
    const linkRow = findLinkOfRow(this.session, key);
    const { selectedLink } = this.session.selection;
    // Revealing the row of a selected link must not clear the selection of other links.
    if (linkRow && selectedLink?.display === linkRow.display.id && selectedLink.link.name === linkRow.link) return;
    const link = linkRow && this.session.robots.get(linkRow.display.id)?.links.find((candidate) => candidate.name === linkRow.link);
    if (linkRow && link) this.session.selection.select({ display: linkRow.display.id, link });
  }

  private showSelection(): void {
    const { selectedLink } = this.session.selection;
    const display = selectedLink && this.session.displays.find(selectedLink.display);
    const path = display && findLinkRowPath(display, this.session, selectedLink.link.name);
    if (path) this.tree.reveal(path);
  }
}

/** Returns the keys of the rows from the outermost group to a display. */
function findPath(display: DisplayState): string[] {
  return [...(display.group ? findPath(display.group) : []), display.id];
}

import { createDockview, type DockviewApi, type IContentRenderer } from "dockview";
import type { PanelName } from "../../protocol";
import { Signal } from "../../signal";
import type { TextStorage } from "../../storage";
import { strings } from "../../strings";
import type { Panel, PanelId } from "../panel";
import { ColumnWidths } from "./column-widths";
import { addPanels, CLASSROOM_PANELS, formOf, DEFAULT_ORDER, type WindowForm } from "./default-layout";
import { DisplayPanels } from "./display-panels";
import { FILE_PANELS } from "./file-panels";
import { FrontTabs } from "./front-tabs";
import type { Layout, Layouts } from "./layouts";
import { PanelTab } from "./panel-tab";
import { SceneTab } from "./scene-tab";
import { bindTabKeys } from "./tab-keys";
import { TimeStrip } from "./time-strip";

/** The dockable panels; the browser stores their arrangement for each file. */
export class Dock {
  /** Emitted when a panel is opened, closed, moved or brought to the front. */
  readonly changed = new Signal();
  /**
   * Emitted when the arrangement is replaced: titles must be set again, and panels that depend on data opened or
   * closed.
   */
  readonly arrangementReplaced = new Signal();
  /** The panels that the file shows, for `reset`; null if it does not specify them. */
  panelsOfFile: readonly PanelName[] | null = null;
  /** Whether the page shows a course, for which panels have other default places. */
  isClassroom = false;
  /** The file for which the arrangement is stored; null until one is known. */
  file: string | null = null;
  /** The panels of displays. */
  readonly displayPanels = new DisplayPanels(() => this.api);
  readonly strip: TimeStrip;
  private readonly api: DockviewApi;
  private readonly columnWidths: ColumnWidths;
  private readonly sceneTab: SceneTab;
  private readonly frontTabs: FrontTabs;
  private readonly panels: ReadonlyMap<string, Panel>;
  private readonly tabs = new Map<string, PanelTab>();
  /** The numbers in the titles, also of closed panels. */
  private readonly counts = new Map<PanelId, number>();
  private form: WindowForm;

  constructor(
    parent: HTMLElement,
    panels: readonly Panel[],
    private readonly layouts: Layouts,
    storage: TextStorage,
  ) {
    this.panels = new Map(panels.map((panel) => [panel.id, panel]));
    this.api = createDockview(parent, {
      createComponent: ({ name }) => this.displayPanels.createContent(name) ?? this.createContent(name),
      createTabComponent: ({ id }) => this.createTab(id),
      theme: { name: "linkwright", className: "dockview-theme-linkwright" },
      disableFloatingGroups: true,
      noPanelsOverlay: "emptyGroup",
      messages: { panelOpened: strings.shell.panelOpened, panelClosed: strings.shell.panelClosed },
    });
    this.columnWidths = new ColumnWidths(this.api);
    this.strip = new TimeStrip(this.api, storage);
    this.sceneTab = new SceneTab(this.api);
    this.frontTabs = new FrontTabs(this.api);
    bindTabKeys(parent, (id) => this.tabs.get(id));
    // Panels get their sizes when they are added; the dock's own observer would report its size too late.
    this.api.layout(parent.clientWidth, parent.clientHeight);
    this.form = formOf(this.api);
    // Usually the file is the one of the last visit, and nothing moves once that is known.
    const latest = layouts.findLatest(this.form);
    if (latest && this.restore(latest)) this.file = latest.file;
    else this.reset();
    this.hideLoneTabs();
    this.columnWidths.remember();
    this.api.onDidLayoutChange(() => {
      this.hideLoneTabs();
      this.columnWidths.restoreAfterChange();
      this.remember();
      this.changed.emit();
    });
    new ResizeObserver(() => {
      this.api.layout(parent.clientWidth, parent.clientHeight);
      if (parent.clientWidth > 0 && formOf(this.api) !== this.form) this.changeForm();
    }).observe(parent);
  }

  /** The panels that can be opened and closed. */
  get ids(): PanelId[] {
    return [...this.panels.values()].map((panel) => panel.id).filter((id) => id !== "scene");
  }

  isOpen(id: PanelId): boolean {
    return this.api.getPanel(id) !== undefined;
  }

  /** Opens a panel at its default position, or brings it to the front. */
  open(id: PanelId): void {
    this.add(id);
    this.api.getPanel(id)?.api.setActive();
    if (id === "time" && this.strip.exists) this.strip.setUnfolded(true);
  }

  close(id: PanelId): void {
    const panel = this.api.getPanel(id);
    if (panel) this.api.removePanel(panel);
  }

  /** Shows a number after a panel's title; 0 removes it. */
  setCount(id: PanelId, count: number): void {
    this.counts.set(id, count);
    this.retitle();
  }

  private retitle(): void {
    const outdatedPanels = this.api.panels.filter(({ id, title }) => this.panels.has(id) && title !== this.titleOf(id));
    for (const { id, api } of outdatedPanels) api.setTitle(this.titleOf(id));
    if (outdatedPanels.length > 0) this.frontTabs.update();
  }

  private titleOf(id: string): string {
    const count = this.counts.get(id as PanelId) ?? 0;
    return count > 0 ? `${translateTitle(id)} (${count})` : translateTitle(id);
  }

  /** Restores the default arrangement. */
  reset(): void {
    if (this.isClassroom) {
      this.build(CLASSROOM_PANELS);
      this.open("lesson");
      this.arrangementReplaced.emit();
      return;
    }
    const areJointsOpen = this.api.getPanel("joints") !== undefined;
    this.build(["scene", "time", "displays", "links", "views", "tool-properties", "selection", "diagnostics", ...(areJointsOpen ? (["joints"] as const) : [])]);
    if (this.panelsOfFile) this.showOnly(this.panelsOfFile);
    this.arrangementReplaced.emit();
  }

  /** Shows the arrangement that the browser stores for a file; returns false if there is none. */
  arrange(file: string): boolean {
    const layout = this.layouts.find(file, this.form);
    if (!layout) return false;
    if (!this.restore(layout)) {
      this.reset();
      return false;
    }
    this.hideLoneTabs();
    this.displayPanels.restore();
    this.columnWidths.remember();
    this.arrangementReplaced.emit();
    return true;
  }

  /** Stores the arrangement for this file from now on. */
  storeFor(file: string): void {
    this.file = file;
    this.remember();
  }

  /** Opens these panels, and closes all others that files can list. */
  showOnly(panels: readonly PanelName[]): void {
    for (const id of FILE_PANELS) {
      if (panels.includes(id)) this.add(id);
      else this.close(id);
    }
    this.columnWidths.restoreAfterChange();
  }

  private add(id: PanelId): void {
    if (this.isOpen(id)) return;
    addPanels(this.api, [id], this.isClassroom);
    this.retitle();
  }

  private build(ids: readonly PanelId[]): void {
    this.api.clear();
    addPanels(this.api, this.form !== "wide" ? [...ids.filter((id) => id !== "time"), ...ids.filter((id) => id === "time")] : ids, this.isClassroom);
    this.retitle();
    this.hideLoneTabs();
    this.displayPanels.restore();
    this.columnWidths.remember();
  }

  /** Hides the tabs of panels that are alone in their group and need no tab. */
  private hideLoneTabs(): void {
    this.strip.update();
    this.sceneTab.update(this.form !== "wide");
    this.frontTabs.update();
  }

  /** Keeps the open panels when the window's form changes, in the arrangement stored for the new form, if any. */
  private changeForm(): void {
    this.form = formOf(this.api);
    if (this.file !== null && this.arrange(this.file)) return;
    this.build(DEFAULT_ORDER.filter((id) => this.isOpen(id)));
    this.arrangementReplaced.emit();
  }

  private createTab(id: string): PanelTab {
    const tab = this.displayPanels.createTab(id) ?? new PanelTab(this.panels.get(id)?.icon ?? "panels", id !== "scene");
    this.tabs.set(id, tab);
    return tab;
  }

  private createContent(name: string): IContentRenderer {
    const panel = this.panels.get(name);
    if (!panel) throw new Error(`no panel '${name}'`);
    return { element: panel.element, init: () => panel.onOpened?.(), dispose: () => panel.onClosed?.() };
  }

  private restore({ arrangement }: Layout): boolean {
    try {
      this.api.fromJSON(arrangement);
      this.retitle();
      return this.isOpen("scene");
    } catch {
      // The layout is from another version of the page: start over.
      this.api.clear();
      return false;
    }
  }

  private remember(): void {
    if (this.file !== null) this.layouts.store({ file: this.file, form: this.form, arrangement: this.api.toJSON() });
  }
}

function translateTitle(id: string): string {
  return strings.panels[id as PanelId];
}

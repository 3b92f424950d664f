// The main file of the package writes its styles into the page at run time; ours come with the page, from its css file.
import { createDockview, type DockviewApi, type IContentRenderer } from "dockview-core/dist/esm";
import { strings } from "../strings";
import { addPanels, TIME_HEIGHT } from "./default-layout";
import { DisplayPanels } from "./display-panels";
import type { Panel, PanelId } from "./panel";
import { PanelTab } from "./panel-tab";

const LAYOUT_KEY = "linkwright.layout.1";

/** The dockable panels; their arrangement is remembered by the browser. */
export class Dock {
  /** The panels of displays. */
  readonly displayPanels = new DisplayPanels(() => this.api);
  private readonly api: DockviewApi;
  private readonly panels: ReadonlyMap<string, Panel>;

  constructor(parent: HTMLElement, panels: readonly Panel[]) {
    this.panels = new Map(panels.map((panel) => [panel.id, panel]));
    this.api = createDockview(parent, {
      createComponent: ({ name }) => this.displayPanels.content(name) ?? this.content(name),
      createTabComponent: ({ id }) => this.displayPanels.tab(id) ?? new PanelTab(this.panels.get(id)?.icon ?? "panels", id !== "scene"),
      theme: { name: "linkwright", className: "dockview-theme-linkwright" },
      disableFloatingGroups: true,
      noPanelsOverlay: "emptyGroup",
    });
    // Panels get their sizes when they are added; the dock's own observer would tell its size only later.
    this.api.layout(parent.clientWidth, parent.clientHeight);
    if (!this.restore()) this.reset();
    this.api.onDidLayoutChange(() => this.remember());
  }

  /** The panels that can be opened and closed. */
  get ids(): PanelId[] {
    return [...this.panels.values()].map((panel) => panel.id).filter((id) => id !== "scene");
  }

  isOpen(id: PanelId): boolean {
    return this.api.getPanel(id) !== undefined;
  }

  /** Opens a panel where it belongs, or brings it to the front. */
  open(id: PanelId): void {
    if (!this.isOpen(id)) addPanels(this.api, [id]);
    this.api.getPanel(id)?.api.setActive();
  }

  close(id: PanelId): void {
    const panel = this.api.getPanel(id);
    if (panel) this.api.removePanel(panel);
  }

  /** A number behind a panel's title; 0 takes it away. */
  setCount(id: PanelId, count: number): void {
    this.api.getPanel(id)?.api.setTitle(count > 0 ? `${title(id)} (${count})` : title(id));
  }

  /** The arrangement of the first visit. */
  reset(): void {
    const joints = this.api.getPanel("joints") !== undefined;
    this.api.clear();
    addPanels(this.api, ["scene", "time", "displays", "links", "views", "tool-properties", "selection", "diagnostics", ...(joints ? (["joints"] as const) : [])]);
    // Added panels take their share of the whole, whatever height they ask for.
    this.api.getPanel("time")?.group.api.setSize({ height: TIME_HEIGHT });
    this.displayPanels.restore();
  }

  private content(name: string): IContentRenderer {
    const panel = this.panels.get(name);
    if (!panel) throw new Error(`no panel '${name}'`);
    return { element: panel.element, init: () => panel.opened?.(), dispose: () => panel.closed?.() };
  }

  private restore(): boolean {
    const saved = localStorage.getItem(LAYOUT_KEY);
    if (saved === null) return false;
    try {
      this.api.fromJSON(JSON.parse(saved) as Parameters<DockviewApi["fromJSON"]>[0]);
      for (const panel of this.api.panels) if (this.panels.has(panel.id)) panel.api.setTitle(title(panel.id));
      return this.isOpen("scene");
    } catch {
      // A layout of another version of the page: start over.
      this.api.clear();
      return false;
    }
  }

  private remember(): void {
    localStorage.setItem(LAYOUT_KEY, JSON.stringify(this.api.toJSON()));
  }
}

function title(id: string): string {
  return strings.panels[id as PanelId];
}

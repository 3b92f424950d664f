import { beforeEach, describe, expect, it, vi } from "vitest";
import { Connection } from "../src/connection/connection";
import { FilePanels, type Arrangement } from "../src/panels/dock/file-panels";
import { Layouts, type Layout } from "../src/panels/dock/layouts";
import type { PanelId } from "../src/panels/panel";
import type { Configuration, PageMessage, PanelName, ServerMessage } from "../src/protocol";
import { Signal } from "../src/signal";

/** A dock without a scene: the browser stores a list of panels for each file. */
class BareDock implements Arrangement {
  readonly changed = new Signal();
  readonly kept = new Map<string, readonly PanelId[]>();
  file: string | null = null;
  panelsOfFile: readonly PanelName[] | null = null;
  isClassroom = false;
  resets = 0;
  shown: readonly PanelId[] = ["displays", "views", "time", "links"];

  open(id: PanelId): void {
    this.use([...this.shown, id]);
  }

  isOpen(id: PanelId): boolean {
    return this.shown.includes(id);
  }

  arrange(file: string): boolean {
    const found = this.kept.get(file);
    if (found) this.shown = found;
    return found !== undefined;
  }

  storeFor(file: string): void {
    this.file = file;
    this.kept.set(file, this.shown);
  }

  reset(): void {
    this.resets += 1;
  }

  showOnly(panels: readonly PanelName[]): void {
    this.shown = [...panels, "links"];
  }

  /** An action of the user. */
  use(open: readonly PanelId[]): void {
    this.shown = open;
    if (this.file !== null) this.kept.set(this.file, open);
    this.changed.emit();
  }
}

let sent: PageMessage[];
let connection: Connection;
let dock: BareDock;

function receive(...messages: ServerMessage[]): void {
  for (const message of messages) connection.message.emit(message);
}

function hello(): void {
  receive({ type: "hello", protocol: 0, version: "", title: "", run: "1" });
}

function configuration(part: Partial<Configuration>): Configuration {
  return { type: "configuration", path: null, opened: 1, unsaved: false, undo: null, redo: null, own: false, recent: [], ...part };
}

/** The messages that a page receives when it connects, or when another configuration is opened. */
function tell(opened: number, path: string | null, shown: PanelName[] | null, origin = "<default>"): void {
  receive({ type: "panels", opened, origin, shown }, configuration({ opened, path }));
}

beforeEach(() => {
  sent = [];
  connection = new Connection("ws://localhost/ws");
  vi.spyOn(connection, "send").mockImplementation((message) => void sent.push(message));
  dock = new BareDock();
  new FilePanels(connection, dock);
  hello();
});

describe("the panels of a file", () => {
  it("are opened when the browser sees the file for the first time", () => {
    tell(1, "/a.rviz", ["displays", "views"]);
    expect(dock.shown).toEqual(["displays", "views", "links"]);
    expect([dock.file, dock.panelsOfFile]).toEqual(["/a.rviz", ["displays", "views"]]);
    expect(sent).toEqual([]);
  });

  it("stay unchanged if the file does not specify any", () => {
    tell(1, "/a.rviz", null);
    expect(dock.shown).toEqual(["displays", "views", "time", "links"]);
  });

  it("are the user's if the browser knows the file", () => {
    dock.kept.set("/a.rviz", ["time", "plot"]);
    tell(1, "/a.rviz", ["displays", "views"]);
    expect(dock.shown).toEqual(["time", "plot"]);
    expect(sent).toEqual([]);
  });

  it("are the file's again when it is opened from the menu", () => {
    dock.kept.set("/b.rviz", ["time", "plot"]);
    tell(1, "/a.rviz", ["displays"]);
    tell(2, "/b.rviz", ["views"]);
    expect(dock.shown).toEqual(["views", "links"]);
    dock.use(["plot"]);
    tell(3, "/b.rviz", ["views"]);
    expect(dock.shown).toEqual(["views", "links"]);
  });

  it("are known once both messages about a configuration have arrived, in either order", () => {
    tell(1, "/a.rviz", ["displays"]);
    receive(configuration({ opened: 2, path: "/b.rviz" }));
    expect(dock.file).toBe("/a.rviz");
    receive({ type: "panels", opened: 2, origin: "", shown: ["time"] });
    expect([dock.file, dock.shown]).toEqual(["/b.rviz", ["time", "links"]]);
  });
});

describe("a course", () => {
  const course: ServerMessage = { type: "course", title: { en: "A course" }, folder: "/ws", file: "", lessons: [] };

  it("arranges the panels when it is shown for the first time", () => {
    receive(course);
    tell(1, null, ["displays"], "/ws");
    expect([dock.isClassroom, dock.resets]).toEqual([true, 1]);
    receive(course);
    expect(dock.resets).toBe(1);
  });

  it("leaves the panels as the user arranged them", () => {
    dock.kept.set("/ws", ["lesson", "plot"]);
    tell(1, null, ["displays"], "/ws");
    receive(course);
    expect([dock.isClassroom, dock.resets, dock.shown]).toEqual([true, 0, ["lesson", "plot"]]);
  });
});

describe("changes by the user", () => {
  it("are sent once, and only for panels that files can name", () => {
    tell(1, "/a.rviz", ["displays", "views"]);
    dock.use(["displays", "views", "links", "plot"]);
    expect(sent).toEqual([]);
    dock.use(["displays", "plot"]);
    dock.use(["displays", "log"]);
    expect(sent).toEqual([{ type: "show_panels", shown: ["displays"] }]);
  });

  it("are not sent before the file is known", () => {
    dock.use(["displays"]);
    expect(sent).toEqual([]);
  });

  it("continue under the name that the file is saved under", () => {
    tell(1, null, ["displays"]);
    expect(dock.file).toBe("<default>");
    dock.use(["displays", "time"]);
    receive(configuration({ opened: 1, path: "/new.rviz" }));
    expect([dock.file, dock.shown]).toEqual(["/new.rviz", ["displays", "time"]]);
    expect(dock.kept.get("/new.rviz")).toEqual(["displays", "time"]);
  });

  it("survive a reconnection", () => {
    tell(1, "/a.rviz", ["displays", "views"]);
    dock.use(["time"]);
    hello();
    tell(1, "/a.rviz", ["time"]);
    expect(dock.shown).toEqual(["time"]);
    hello(); // another program
    tell(1, "/c.rviz", ["views"]);
    expect(dock.shown).toEqual(["views", "links"]);
    expect(sent).toHaveLength(1);
  });
});

describe("the arrangements stored in the browser", () => {
  const texts = new Map<string, string>();
  const layouts = new Layouts({ getItem: (key) => texts.get(key) ?? null, setItem: (key, text) => void texts.set(key, text) });
  const layout = (file: string, form: Layout["form"] = "wide"): Layout => ({ file, form, arrangement: { panels: {} } as Layout["arrangement"] });

  beforeEach(() => texts.clear());

  it("are those of the last files, newest first", () => {
    expect([layouts.findLatest("wide"), layouts.find("/0.rviz", "wide")]).toEqual([null, null]);
    for (let i = 0; i < 20; i++) layouts.store(layout(`/${i}.rviz`));
    expect(layouts.findLatest("wide")?.file).toBe("/19.rviz");
    expect(layouts.find("/8.rviz", "wide")?.file).toBe("/8.rviz");
    expect(layouts.find("/7.rviz", "wide")).toBeNull();
    layouts.store(layout("/8.rviz"));
    expect(layouts.findLatest("wide")?.file).toBe("/8.rviz");
  });

  it("differ by the form of the window", () => {
    layouts.store(layout("/a.rviz", "narrow"));
    layouts.store(layout("/b.rviz"));
    expect(layouts.findLatest("narrow")?.file).toBe("/a.rviz");
    expect(layouts.find("/a.rviz", "wide")).toBeNull();
    layouts.store(layout("/a.rviz"));
    expect(layouts.find("/a.rviz", "narrow")?.form).toBe("narrow");
    expect(layouts.find("/a.rviz", "wide")?.form).toBe("wide");
    expect(layouts.find("/a.rviz", "low")).toBeNull();
  });

  it("are empty if the stored value is invalid", () => {
    for (const text of ["{", "7", '{"file": 1}', '[{"file": "/a.rviz", "arrangement": {}}]', "[null, 3, {}]"]) {
      texts.set("linkwright.layouts.3", text);
      expect(layouts.findLatest("wide")).toBeNull();
    }
  });
});

describe("the voice panel", () => {
  const node = (present: boolean): ServerMessage => ({ type: "voice_node", present });

  it("opens for a robot that listens, even if a file names its open panels, in either order", () => {
    receive(node(false));
    tell(1, "/a.rviz", ["displays"]);
    expect(dock.isOpen("voice")).toBe(false);
    receive(node(true));
    expect(dock.isOpen("voice")).toBe(true);
  });

  it("stays closed after the user has closed it", () => {
    receive(node(true));
    tell(1, "/a.rviz", ["displays"]);
    expect(dock.isOpen("voice")).toBe(true);
    dock.use(["displays"]);
    receive(node(true));
    hello();
    tell(1, "/a.rviz", ["displays"]);
    receive(node(true));
    expect(dock.isOpen("voice")).toBe(false);
  });
});

describe("the teleop pad", () => {
  const simulation = (drivable: boolean): ServerMessage => ({
    type: "simulation_status", present: true, drivable, paused: false, time: null, real_time_factor: null,
  });

  it("opens for a simulated robot that drives, in either order", () => {
    tell(1, null, ["displays"], "robot.urdf");
    receive(simulation(false));
    expect(dock.isOpen("teleop")).toBe(false);
    receive(simulation(true));
    expect(dock.isOpen("teleop")).toBe(true);
    tell(2, null, ["displays"], "other.urdf");
    expect(dock.isOpen("teleop")).toBe(true);
  });

  it("stays closed after the user has closed it", () => {
    tell(1, null, ["displays"], "robot.urdf");
    receive(simulation(true));
    dock.use(["displays"]);
    receive(simulation(false), simulation(true));
    hello();
    tell(1, null, ["displays"], "robot.urdf");
    receive(simulation(true));
    expect(dock.isOpen("teleop")).toBe(false);
  });

  it("stays closed if a file names its open panels", () => {
    tell(1, "/a.rviz", ["displays"]);
    receive(simulation(true));
    expect(dock.isOpen("teleop")).toBe(false);
  });
});

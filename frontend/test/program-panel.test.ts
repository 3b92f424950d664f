import { describe, expect, it, vi } from "vitest";
import { Connection } from "../src/connection/connection";
import type { ProgramPage, ServerMessage } from "../src/protocol";
import { takeRequested, withSettings } from "../src/requested-settings";
import { TerminalsState } from "../src/state/terminals";

const WORLD: ProgramPage = { id: 1, title: "world", url: "http://127.0.0.1:7449/?token=abc" };

function made(): { state: TerminalsState; sent: unknown[]; receive: (message: object) => void; news: boolean[] } {
  const connection = new Connection("ws://localhost/ws");
  const sent: unknown[] = [];
  vi.spyOn(connection, "send").mockImplementation((message) => void sent.push(message));
  const state = new TerminalsState(connection);
  const news: boolean[] = [];
  state.programsChanged.on((hasNew) => news.push(hasNew));
  return { state, sent, receive: (message) => connection.message.emit(message as ServerMessage), news };
}

const terminals = (folder: string): object => ({ type: "terminals", folder, terminals: [], why_not: "" });

describe("the pages of programs", () => {
  it("are requested once for each connection, where there are terminals", () => {
    const { sent, receive } = made();
    for (const message of [{ type: "hello" }, terminals("/ws"), terminals("/ws")]) receive(message);
    expect(sent).toEqual([{ type: "watch_program_pages" }]);
    for (const message of [{ type: "hello" }, terminals("")]) receive(message);
    expect(sent).toHaveLength(1);
  });

  it("are new, are kept and end", () => {
    const { state, receive, news } = made();
    receive(terminals("/ws"));
    for (const pages of [[WORLD], [WORLD, { ...WORLD, id: 2 }], [WORLD], []]) receive({ type: "program_pages", pages });
    expect(news).toEqual([true, true, false, false]);
    receive({ type: "program_pages", pages: [WORLD] });
    receive({ type: "hello" });
    receive({ type: "frame_table" });
    expect(state.programs).toEqual([]);
  });
});

describe("the settings of a program's page", () => {
  it("are those of the page around it, and do not stay in its address", () => {
    const address = withSettings(WORLD.url, { language: "zh", theme: "dark" });
    expect(address).toBe("http://127.0.0.1:7449/?token=abc&language=zh&theme=dark");
    const location = { href: address };
    const history = { state: null, replaceState: (_: unknown, unused: string, url: URL) => (location.href = url.href + unused) };
    const take = (setting: "language" | "theme"): string | null => takeRequested(setting, location as Location, history as unknown as History);
    expect([take("language"), take("theme"), take("theme")]).toEqual(["zh", "dark", null]);
    expect(location.href).toBe(WORLD.url);
    expect(takeRequested("language", undefined, undefined)).toBeNull();
  });
});

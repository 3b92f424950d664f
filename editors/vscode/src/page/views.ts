import type { Command } from "../server/command.js";
import { View } from "./view.js";

/** The running views, one for each file. */
export class Views {
  private readonly running = new Map<string, View>();

  constructor(private readonly log: (line: string) => void) {}

  /** Return the address of a file's page; starts `linkwright view` unless it runs. */
  address(command: Command, file: string, cwd: string | undefined): Promise<string> {
    let view = this.running.get(file);
    if (view === undefined) {
      const started = new View(command, file, cwd, this.log);
      this.running.set(file, started);
      void started.ended.then(() => this.running.delete(file));
      view = started;
    }
    return view.address;
  }

  /** End all views. */
  dispose(): void {
    for (const view of this.running.values()) view.stop();
  }
}

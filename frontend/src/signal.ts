/** A typed event with listeners. */
export class Signal<T = void> {
  private readonly listeners = new Set<(value: T) => void>();

  /** Calls `listener` on every `emit`, until the returned function is called. */
  on(listener: (value: T) => void): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  emit(value: T): void {
    for (const listener of [...this.listeners]) listener(value);
  }
}

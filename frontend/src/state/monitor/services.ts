import type { Connection } from "../../connection/connection";
import type { ServiceRequest, ServiceResponse, ServiceRow } from "../../protocol";
import { Signal } from "../../signal";

/** The services, and the request that the user writes for one of them. */
export class ServicesState {
  readonly listChanged = new Signal();
  readonly changed = new Signal();
  services: readonly ServiceRow[] = [];
  service = "";
  /** The request with default values; null until it has arrived. */
  request: ServiceRequest | null = null;
  response: ServiceResponse | null = null;
  isCalling = false;
  private isWatching = false;

  constructor(private readonly connection: Connection) {
    connection.on("hello", () => {
      this.isCalling = false;
      if (this.isWatching) this.connection.send({ type: "watch_services", watched: true });
      this.changed.emit();
    });
    connection.on("service_list", ({ services }) => {
      const wasListed = this.isListed(this.service);
      this.services = services;
      if (!wasListed && this.request === null) this.askForRequest();
      this.listChanged.emit();
    });
    connection.on("service_request", (request) => {
      if (request.service !== this.service) return;
      this.request = request;
      this.changed.emit();
    });
    connection.on("service_response", (response) => {
      if (response.service !== this.service) return;
      this.response = response;
      this.isCalling = false;
      this.changed.emit();
    });
  }

  watch(isWatched: boolean): void {
    if (isWatched === this.isWatching) return;
    this.isWatching = isWatched;
    this.connection.send({ type: "watch_services", watched: isWatched });
  }

  choose(service: string): void {
    this.service = service;
    this.request = null;
    this.response = null;
    this.isCalling = false;
    this.askForRequest();
    this.changed.emit();
  }

  isListed(service: string): boolean {
    return this.services.some(({ name }) => name === service);
  }

  call(text: string): void {
    if (this.request === null) return;
    this.isCalling = true;
    this.response = null;
    this.connection.send({ type: "call_service", service: this.service, text });
    this.changed.emit();
  }

  private askForRequest(): void {
    if (this.isListed(this.service)) this.connection.send({ type: "choose_service", service: this.service });
  }
}

// The page by itself: messages go through a WebSocket of the server that has sent it.
import { start } from "./viewer.js";

class Socket {
  constructor() {
    const url = new URL("socket", location.href);
    url.protocol = "ws:";
    this.socket = new WebSocket(url);
    this.socket.binaryType = "arraybuffer";
    this.waiting = [];
    this.socket.onopen = () => { for (const text of this.waiting.splice(0)) this.socket.send(text); };
    this.socket.onmessage = (event) => this.receive(event.data);
    this.socket.onclose = () => this.closed();
  }
  send(message) {
    const text = JSON.stringify(message);
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(text);
    else this.waiting.push(text);
  }
}

window.moteView = start(document.getElementById("mote"), new Socket());
window.moteView.stage.focus();  // for the keys

// Resolves to a port of 127.0.0.1 that is free at the moment.

import net from "node:net";

export const free_port = () =>
  new Promise((resolve, reject) => {
    const server = net.createServer();
    server.once("error", reject);
    server.listen(0, "127.0.0.1", () => {
      const { port } = server.address();
      server.close(() => resolve(port));
    });
  });

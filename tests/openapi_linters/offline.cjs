// Loaded before a linter: whoever asks the network is ended.
const dns = require('node:dns');
const net = require('node:net');
const { syncBuiltinESMExports } = require('node:module');

function end() {
  console.error('The network was asked.');
  process.exit(97);
}

dns.lookup = end;
net.Socket.prototype.connect = end;
syncBuiltinESMExports();

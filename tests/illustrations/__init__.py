"""Pictures and data that documentation and page show, each drawn by a command of its own."""

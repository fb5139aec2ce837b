# Install rules and the package that find_package(edgesplat) finds.

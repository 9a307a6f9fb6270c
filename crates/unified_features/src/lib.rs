//! No code: with this dependency, a package that is built alone has the dependencies that the whole workspace
//! has, with the same features, and none is built twice.

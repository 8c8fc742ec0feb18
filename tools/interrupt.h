#pragma once

namespace plumbline {

/// From now on the first SIGINT asks for an orderly end; a second one kills as usual.
void catch_interrupts();

/// Whether an orderly end has been asked for.
bool interrupted();

}  // namespace plumbline

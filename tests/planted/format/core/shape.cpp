namespace hbar {

int right(int a) { return a + 1; }
// planted: format
int  wrong( int a ) { return a+1; }

}  // namespace hbar
